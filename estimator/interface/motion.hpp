// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "core/lie.hpp"
#include "core/time.hpp"

namespace aims {

/// Pose and twist of the body at an instant, with their covariance.
struct MotionEstimate {
  Time stamp = 0;
  Pose T_odom_body;
  Eigen::Vector3d velocity = Eigen::Vector3d::Zero();          ///< in odometry axes [m/s]
  Eigen::Vector3d angular_velocity = Eigen::Vector3d::Zero();  ///< in body axes [rad/s]
  /// Of the errors of rotation (R = R_hat Exp(d), [rad]), position and velocity (odometry axes).
  Eigen::Matrix<double, 9, 9> covariance = Eigen::Matrix<double, 9, 9>::Zero();
  Eigen::Matrix3d rate_covariance = Eigen::Matrix3d::Zero();  ///< of the angular velocity
};

/// What some estimators know besides their result, for those who act on it at once.
class MotionSource {
 public:
  virtual ~MotionSource() = default;

  /// The state after the last correction, predicted by the IMU to `until` or the newest sample,
  /// whichever is first; never before that correction. None before the start.
  virtual std::optional<MotionEstimate> motion(Time until) const = 0;

  /// Points of the last scan that extended the map, deskewed, in the odometry frame [m].
  virtual const std::vector<Eigen::Vector3f>& registered_points() const = 0;

 protected:
  MotionSource() = default;
  MotionSource(const MotionSource&) = default;
  MotionSource& operator=(const MotionSource&) = default;
};

}  // namespace aims
