// SPDX-License-Identifier: BSD-3-Clause
#include "sim/sensors/inertial_errors.hpp"

#include <cmath>
#include <string>

namespace aims {
namespace {

/// Independent terms of that standard deviation.
Eigen::Matrix3d drawn_matrix(double sigma, RandomStream& random) {
  Eigen::Matrix3d terms;
  for (int axis = 0; axis < 3; ++axis) terms.row(axis) = sigma * random.normal3().transpose();
  return terms;
}

/// Second draw of the stream "name" of the robot; that of the run, if it is another, leaves it out.
Eigen::Vector3d drawn_scale(const InertialErrorConfig& errors, RunSeeds seeds,
                            std::string_view name, RandomStream& of_run) {
  RandomStream of_robot(seeds.robot, name);
  of_robot.normal3();
  of_run.normal3();
  return Eigen::Vector3d::Ones() + errors.scale_error * of_robot.normal3();
}

}  // namespace

BiasDrift::BiasDrift(double sigma, double correlation_time, std::uint64_t run_seed,
                     std::string_view name)
    : kept_(std::exp(-1.0 / correlation_time)),
      added_(sigma * std::sqrt(1.0 - kept_ * kept_)),
      random_(run_seed, name),
      before_(sigma * random_.normal3()),
      after_(kept_ * before_ + added_ * random_.normal3()) {}

Eigen::Vector3d BiasDrift::at(Time stamp) {
  if (second_ < 0) second_ = stamp;
  while (stamp - second_ >= kSecond) {
    second_ += kSecond;
    before_ = after_;
    after_ = kept_ * before_ + added_ * random_.normal3();
  }
  return before_ + to_seconds(stamp - second_) * (after_ - before_);
}

InertialTriad::InertialTriad(const InertialErrorConfig& errors, double interval, double bandwidth,
                             RunSeeds seeds, std::string_view name)
    : errors_(errors),
      walk_step_(errors.bias_walk * std::sqrt(interval)),
      noise_sigma_(2.0 * bandwidth * interval > 1.0
                       ? errors.noise_density * std::sqrt(2.0 * bandwidth)
                       : errors.noise_density / std::sqrt(interval)),
      random_(seeds.run, name),
      walked_(errors.turn_on_bias * random_.normal3()),
      scale_(drawn_scale(errors, seeds, name, random_)),
      drift_(errors.drift, errors.drift_time, seeds.run, std::string(name) + ".drift"),
      bias_(walked_) {
  RandomStream axes(seeds.robot, std::string(name) + ".axes");
  cross_axis_ = drawn_matrix(errors.misalignment, axes);
  cross_axis_.diagonal().setZero();
  g_sensitivity_ = drawn_matrix(errors.g_sensitivity, axes);
  if (errors.drift > 0.0) bias_ += drift_.at(0);
}

Eigen::Vector3d InertialTriad::measure(Time stamp, const Eigen::Vector3d& truth,
                                       const Eigen::Vector3d& force) {
  Eigen::Vector3d value = scale_.cwiseProduct(truth) + bias_ + noise_sigma_ * random_.normal3();
  if (errors_.misalignment > 0.0) value += cross_axis_ * truth;
  if (errors_.g_sensitivity > 0.0) value += g_sensitivity_ * force;
  walked_ += walk_step_ * random_.normal3();
  bias_ = walked_;
  if (errors_.drift > 0.0) bias_ += drift_.at(stamp);
  value = value.cwiseMax(-errors_.range).cwiseMin(errors_.range);
  if (errors_.resolution <= 0.0) return value;
  return errors_.resolution * (value / errors_.resolution).array().round();
}

void describe_errors(Fields& f, std::string_view prefix, InertialErrorConfig& c) {
  const bool gyro = prefix == "gyro";
  const std::string unit = gyro ? "rad/s" : "m/s^2";
  const std::string name = std::string(prefix) + "_";
  f.number(name + "noise_density", c.noise_density,
           {.unit = unit + "/sqrt(Hz)",
            .range = up_to(1e3),
            .meaning = "Density of the white noise.",
            .source = gyro ? "MEMS datasheets: 0.005-0.015 deg/s/sqrt(Hz)"
                           : "MEMS datasheets: 60-250 ug/sqrt(Hz)"});
  f.number(name + "bias_walk", c.bias_walk,
           {.unit = unit + "/sqrt(s)", .range = up_to(1e3), .meaning = "Random walk of the bias."});
  f.number(name + "turn_on_bias", c.turn_on_bias,
           {.unit = unit,
            .range = up_to(1e3),
            .meaning = "Standard deviation per axis of the bias at the start of a run."});
  f.number(name + "scale_error", c.scale_error,
           {.unit = "-",
            .range = in_range(0.0, 0.2),
            .meaning = "Standard deviation per axis of the scale error, constant in a run."});
  f.number(name + "range", c.range,
           {.unit = unit,
            .range = positive_up_to(1e3),
            .meaning = "Magnitude at which an axis saturates."});
  f.number(
      name + "misalignment", c.misalignment,
      {.unit = "-",
       .range = in_range(0.0, 0.2),
       .meaning = "Standard deviation of the coupling of each axis into another, constant in a run "
                  "(cross-axis sensitivity and misalignment)."});
  f.number(name + "drift", c.drift,
           {.unit = unit,
            .range = up_to(1e3),
            .meaning = "Standard deviation per axis of the bias's slow drift, as by temperature."});
  f.number(name + "drift_time", c.drift_time,
           {.unit = "s",
            .range = in_range(1.0, 1e6),
            .meaning = "Correlation time of that drift, a first-order Gauss-Markov process."});
  f.idle_if(c.drift <= 0.0, name + "drift is 0", {name + "drift_time"});
  if (gyro) {
    f.number(name + "g_sensitivity", c.g_sensitivity,
             {.unit = "rad/s per m/s^2",
              .range = up_to(1.0),
              .meaning = "Standard deviation of the gyro's answer to each axis of the specific "
                         "force, constant in a run."});
  }
  f.number(
      name + "resolution", c.resolution,
      {.unit = unit, .range = up_to(10.0), .meaning = "Step of the output; 0: not quantized."});
}

}  // namespace aims
