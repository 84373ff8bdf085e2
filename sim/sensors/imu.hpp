// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>

#include "core/config.hpp"
#include "core/error.hpp"
#include "core/measurements.hpp"
#include "core/random.hpp"
#include "sim/robot/truth.hpp"

namespace aims {

/// Errors of one inertial triad, as in a datasheet; unit: rad/s or m/s^2.
struct InertialErrorConfig {
  double noise_density = 0.0;  ///< white noise [unit/sqrt(Hz)]
  double bias_walk = 0.0;      ///< random walk of the bias [unit/sqrt(s)]
  double turn_on_bias = 0.0;   ///< standard deviation per axis of the bias at the start [unit]
  double scale_error = 0.0;    ///< standard deviation per axis of the scale, drawn per run [-]
  double range = 0.0;          ///< magnitude at which each axis saturates [unit]
};

struct ImuConfig {
  double rate = 50.0;  ///< samples per second [Hz]
  ImuSampling sampling = ImuSampling::kMean;
  InertialErrorConfig gyro = {2e-4, 2e-5, 2e-3, 0.0, 17.4};
  InertialErrorConfig accelerometer = {1.5e-3, 2e-4, 0.03, 0.0, 78.5};
};
void describe(Fields& f, ImuConfig& c);

/// Error when the rate does not divide the physics rate.
Result<void> validate(const ImuConfig& config, Duration timestep);

/// An inertial measurement unit that moves with the body frame.
class Imu {
 public:
  /// `config` is valid. Random streams: "imu.gyro", "imu.accelerometer".
  Imu(const ImuConfig& config, Duration timestep, std::uint64_t run_seed);

  /// Processes the true motion before the first and after each physics step; returns a sample at
  /// the end of each interval. An average of rates is the rotation over the interval divided by its
  /// length; an average of specific forces is the mean of the force in the turning body's axes, so
  /// integrating it at the interval's middle attitude reproduces the change of velocity.
  std::optional<ImuSample> sample(const TruthSample& motion);

  const Eigen::Vector3d& gyro_bias() const { return gyro_.bias; }                    ///< [rad/s]
  const Eigen::Vector3d& accelerometer_bias() const { return accelerometer_.bias; }  ///< [m/s^2]

 private:
  /// One triad: its errors and their state.
  struct Triad {
    Triad(const InertialErrorConfig& errors, double interval, std::uint64_t seed,
          std::string_view name);
    Eigen::Vector3d measure(const Eigen::Vector3d& truth);

    InertialErrorConfig errors;
    double interval;  ///< between samples [s]
    RandomStream random;
    Eigen::Vector3d bias;
    Eigen::Vector3d scale;
  };

  ImuSampling sampling_;
  int steps_;
  Triad gyro_;
  Triad accelerometer_;
  std::optional<TruthSample> last_;
  TruthSample interval_start_;
  Eigen::Vector3d force_sum_ = Eigen::Vector3d::Zero();  ///< over the interval's steps [m/s^2]
  int count_ = 0;
};

}  // namespace aims
