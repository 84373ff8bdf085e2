// SPDX-License-Identifier: BSD-3-Clause
#include "sim/sensors/imu.hpp"

#include <cmath>

#include "sim/sensors/sampling.hpp"

namespace aims {
namespace {

constexpr double kGravity = 9.81;  ///< [m/s^2]

/// Mean specific force over one physics step, in the axes of the body in the middle of the step.
Eigen::Vector3d specific_force(const TruthSample& before, const TruthSample& after) {
  const double dt = to_seconds(after.stamp - before.stamp);
  const Eigen::Vector3d in_world =
      (after.velocity - before.velocity) / dt + Eigen::Vector3d(0.0, 0.0, kGravity);
  const Eigen::Quaterniond middle =
      before.T_world_body.rotation.slerp(0.5, after.T_world_body.rotation);
  return middle.conjugate() * in_world;
}

/// Mean angular velocity between two attitudes, in body axes.
Eigen::Vector3d mean_rate(const TruthSample& before, const TruthSample& after) {
  return so3_log(before.T_world_body.rotation.conjugate() * after.T_world_body.rotation) /
         to_seconds(after.stamp - before.stamp);
}

/// Noise of a sample at an instant has the power that the chip's filter lets pass.
InertialTriad triad(const ImuConfig& config, const InertialErrorConfig& errors, RunSeeds seeds,
                    std::string_view name) {
  const bool point = config.sampling == ImuSampling::kPoint;
  const double bandwidth = point ? noise_bandwidth(config.bandwidth, config.filter_order) : 0.0;
  return {errors, 1.0 / config.rate, bandwidth, seeds, name};
}

}  // namespace

Result<void> validate(const ImuConfig& config, Duration timestep) {
  const auto steps = steps_per_sample("imu.rate", config.rate, timestep);
  if (!steps) return tl::unexpected(steps.error());
  return {};
}

Imu::Imu(const ImuConfig& config, Duration timestep, RunSeeds seeds)
    : sampling_(config.sampling),
      steps_(*steps_per_sample("imu.rate", config.rate, timestep)),
      gyro_(triad(config, config.gyro, seeds, "imu.gyro")),
      accelerometer_(triad(config, config.accelerometer, seeds, "imu.accelerometer")),
      vibration_(config.vibration, to_seconds(timestep), seeds),
      gyro_filter_(config.bandwidth, config.filter_order, to_seconds(timestep)),
      accelerometer_filter_(config.bandwidth, config.filter_order, to_seconds(timestep)),
      disturbed_(config.bandwidth > 0.0 || vibration_.active()) {}

Vibration Imu::disturbance(const Vibration& truth, const FootLoads& loads) {
  const Vibration added = vibration_.step(loads);
  const Eigen::Vector3d force =
      accelerometer_filter_.filter(truth.acceleration + added.acceleration);
  const Eigen::Vector3d rate = gyro_filter_.filter(truth.rate + added.rate);
  return {force - truth.acceleration, rate - truth.rate};
}

std::optional<ImuSample> Imu::sample(const TruthSample& motion, const FootLoads& loads) {
  if (!last_) {
    last_ = motion;
    interval_start_ = motion;
    return std::nullopt;
  }
  const bool average = sampling_ == ImuSampling::kMean;
  const Eigen::Vector3d force = specific_force(*last_, motion);
  Vibration added;
  if (disturbed_) {
    added =
        disturbance({force, average ? mean_rate(*last_, motion) : motion.angular_velocity}, loads);
    disturbance_sum_.acceleration += added.acceleration;
    disturbance_sum_.rate += added.rate;
  }
  force_sum_ += force;
  last_ = motion;
  if (++count_ < steps_) return std::nullopt;

  Vibration sensed = {force, motion.angular_velocity};
  if (average) {
    sensed = {force_sum_ / steps_, mean_rate(interval_start_, motion)};
    added = {disturbance_sum_.acceleration / steps_, disturbance_sum_.rate / steps_};
  }
  if (disturbed_) {
    sensed.acceleration += added.acceleration;
    sensed.rate += added.rate;
  }
  ImuSample sample;
  sample.stamp = motion.stamp;
  sample.angular_velocity = gyro_.measure(motion.stamp, sensed.rate, sensed.acceleration);
  sample.specific_force =
      accelerometer_.measure(motion.stamp, sensed.acceleration, sensed.acceleration);
  interval_start_ = motion;
  force_sum_.setZero();
  disturbance_sum_ = {};
  count_ = 0;
  return sample;
}

void describe(Fields& f, ImuConfig& c) {
  f.number("rate", c.rate,
           {.unit = "Hz",
            .range = in_range(1.0, 2000.0),
            .meaning = "Samples per second.",
            .source = "paper, III-A"});
  f.choice("sampling", c.sampling, {{"mean", ImuSampling::kMean}, {"point", ImuSampling::kPoint}},
           {.unit = "-", .meaning = "Mean over the sample interval, or the value at its end."});
  f.number("bandwidth", c.bandwidth,
           {.unit = "Hz",
            .range = in_range(0.0, 2000.0),
            .meaning = "Bandwidth (-3 dB) of the chip's low-pass before it samples; 0 for none."});
  f.integer("filter_order", c.filter_order,
            {.unit = "-",
             .range = in_range(1, 2),
             .meaning = "Order of that low-pass: 1, or 2 (Butterworth)."});
  f.idle_if(c.bandwidth <= 0.0, "bandwidth is 0", {"filter_order"});
  describe_errors(f, "gyro", c.gyro);
  describe_errors(f, "accelerometer", c.accelerometer);
  f.group("vibration", c.vibration);
}

}  // namespace aims
