// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <deque>
#include <optional>

#include "core/measurements.hpp"
#include "estimator/aims/config.hpp"
#include "estimator/filter/kalman_update.hpp"

namespace aims {

/// Means of the IMU over a window, and how much it leaves them.
struct ImuRest {
  Eigen::Vector3d rate = Eigen::Vector3d::Zero();  ///< mean [rad/s], gyro bias included
  double rate_deviation = 0.0;   ///< largest distance of a sample from the mean [rad/s]
  double force_deviation = 0.0;  ///< largest distance of a sample from the mean [m/s^2]
};

/// The samples of (end - window, end]; empty when they do not cover it.
std::optional<ImuRest> imu_rest(const std::deque<ImuSample>& samples, Time end, Duration window);

/// Residual of a body at rest: its velocity in body axes [m/s].
LinearMeasurement zero_velocity(const NominalState& state, double sigma);

/// Residual of a gyro whose mean reading at rest is `rate` [rad/s]: its bias less that rate.
LinearMeasurement resting_gyro(const NominalState& state, const Eigen::Vector3d& rate,
                               double sigma);

/// Tells when the robot stands still, from IMU and legs together: easily lost, slowly gained.
class StandstillDetector {
 public:
  explicit StandstillDetector(const StandstillConfig& config) : config_(config) {}

  /// Takes the next sample of the legs with the IMU's samples until then; `gyro_bias` is the
  /// present estimate [rad/s]. True while the robot stands.
  bool observe(const LegOdometrySample& legs, const std::deque<ImuSample>& imu,
               const Eigen::Vector3d& gyro_bias);

  /// The IMU's rest if a measurement is due: one per window, since the errors of neighbours repeat.
  std::optional<ImuRest> due();

 private:
  bool legs_rest(const LegOdometrySample& legs, double factor);

  StandstillConfig config_;
  bool standing_ = false;
  Eigen::Vector3d smoothed_velocity_ = Eigen::Vector3d::Zero();  ///< of the legs [m/s]
  double smoothed_joint_square_ = 0.0;                           ///< mean square of all [rad^2/s^2]
  std::optional<Time> last_;
  std::optional<Time> resting_since_;
  std::optional<Time> last_measured_;
  std::optional<ImuRest> rest_;
};

}  // namespace aims
