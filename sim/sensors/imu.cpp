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

void describe_errors(Fields& f, std::string_view prefix, InertialErrorConfig& c,
                     const std::string& unit, const std::string& source) {
  const std::string name(prefix);
  f.number(name + "_noise_density", c.noise_density,
           {.unit = unit + "/sqrt(Hz)",
            .range = up_to(1e3),
            .meaning = "Density of the white noise.",
            .source = source});
  f.number(name + "_bias_walk", c.bias_walk,
           {.unit = unit + "/sqrt(s)", .range = up_to(1e3), .meaning = "Random walk of the bias."});
  f.number(name + "_turn_on_bias", c.turn_on_bias,
           {.unit = unit,
            .range = up_to(1e3),
            .meaning = "Standard deviation per axis of the bias at the start of a run."});
  f.number(name + "_scale_error", c.scale_error,
           {.unit = "-",
            .range = in_range(0.0, 0.2),
            .meaning = "Standard deviation per axis of the scale error, constant in a run."});
  f.number(name + "_range", c.range,
           {.unit = unit,
            .range = positive_up_to(1e3),
            .meaning = "Magnitude at which an axis saturates."});
}

}  // namespace

Imu::Triad::Triad(const InertialErrorConfig& e, double sample_interval, std::uint64_t seed,
                  std::string_view name)
    : errors(e),
      interval(sample_interval),
      random(seed, name),
      bias(e.turn_on_bias * random.normal3()),
      scale(Eigen::Vector3d::Ones() + e.scale_error * random.normal3()) {}

Eigen::Vector3d Imu::Triad::measure(const Eigen::Vector3d& truth) {
  const double noise = errors.noise_density / std::sqrt(interval);
  const Eigen::Vector3d value = scale.cwiseProduct(truth) + bias + noise * random.normal3();
  bias += errors.bias_walk * std::sqrt(interval) * random.normal3();
  return value.cwiseMax(-errors.range).cwiseMin(errors.range);
}

Result<void> validate(const ImuConfig& config, Duration timestep) {
  const auto steps = steps_per_sample("imu.rate", config.rate, timestep);
  if (!steps) return tl::unexpected(steps.error());
  return {};
}

Imu::Imu(const ImuConfig& config, Duration timestep, std::uint64_t run_seed)
    : sampling_(config.sampling),
      steps_(*steps_per_sample("imu.rate", config.rate, timestep)),
      gyro_(config.gyro, 1.0 / config.rate, run_seed, "imu.gyro"),
      accelerometer_(config.accelerometer, 1.0 / config.rate, run_seed, "imu.accelerometer") {}

std::optional<ImuSample> Imu::sample(const TruthSample& motion) {
  if (!last_) {
    last_ = motion;
    interval_start_ = motion;
    return std::nullopt;
  }
  const Eigen::Vector3d force = specific_force(*last_, motion);
  force_sum_ += force;
  last_ = motion;
  if (++count_ < steps_) return std::nullopt;

  const bool average = sampling_ == ImuSampling::kMean;
  ImuSample sample;
  sample.stamp = motion.stamp;
  sample.angular_velocity =
      gyro_.measure(average ? mean_rate(interval_start_, motion) : motion.angular_velocity);
  sample.specific_force =
      accelerometer_.measure(average ? Eigen::Vector3d(force_sum_ / steps_) : force);
  interval_start_ = motion;
  force_sum_.setZero();
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
  describe_errors(f, "gyro", c.gyro, "rad/s", "MEMS datasheets: 0.005-0.015 deg/s/sqrt(Hz)");
  describe_errors(f, "accelerometer", c.accelerometer, "m/s^2",
                  "MEMS datasheets: 60-250 ug/sqrt(Hz)");
}

}  // namespace aims
