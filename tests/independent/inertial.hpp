// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "core/measurements.hpp"
#include "tests/independent/motion.hpp"

namespace aims::independent {

using Vector6d = Eigen::Matrix<double, 6, 1>;

/// Vibration of the IMU's mount: every footfall excites damped oscillations between 18 and 90 Hz.
class Vibration {
 public:
  /// Scaled to those deviations per axis, over the time walked.
  Vibration(const Walk& walk, double force_deviation, double rate_deviation, std::uint64_t seed);

  /// Angular velocity [rad/s], then specific force [m/s^2]; both integrate to zero.
  Vector6d at(double t) const;

 private:
  static constexpr int kModes = 5;
  struct Footfall {
    double time = 0.0;                          ///< [s]
    Eigen::Matrix<double, 6, kModes> strength;  ///< by channel and mode
  };

  std::vector<Footfall> footfalls_;  ///< in order of time
  Vector6d scale_ = Vector6d::Ones();
};

struct InertialOptions {
  double rate_hz = 200.0;
  double force_vibration = 0.4;       ///< deviation while walking [m/s^2]
  double rate_vibration = 0.02;       ///< deviation while walking [rad/s]
  double noise_bandwidth_hz = 200.0;  ///< of the sensor before it is sampled
  double gyro_noise = 1.2e-4;         ///< 0.007 deg/s/sqrt(Hz) [rad/s/sqrt(Hz)]
  double force_noise = 1.0e-3;        ///< 0.1 mg/sqrt(Hz) [m/s^2/sqrt(Hz)]
  double gyro_bias = 2.0e-3;          ///< deviation over seeds [rad/s]
  double force_bias = 0.03;           ///< deviation over seeds [m/s^2]
  double gyro_walk = 2.0e-5;          ///< [rad/s/sqrt(s)]
  double force_walk = 2.0e-4;         ///< [m/s^2/sqrt(s)]
  std::uint64_t seed = 1;
};

/// Without noise, bias and vibration.
InertialOptions ideal_inertial(double rate_hz);

/// Values at their stamps, not means: what vibrates above half the rate aliases.
std::vector<ImuSample> sample_inertial(const Walk& walk, const InertialOptions& options);

}  // namespace aims::independent
