// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>

#include "core/lie.hpp"

namespace aims::leg_kilo {

/// State of the filter. Specific force and angular rate are states, which the IMU measures. The
/// world is the IMU's frame at the start, so gravity is a vector in it.
struct State {
  Pose T_world_body;                                             ///< of the IMU
  Eigen::Vector3d velocity = Eigen::Vector3d::Zero();            ///< v_world_body [m/s]
  Eigen::Vector3d accelerometer_bias = Eigen::Vector3d::Zero();  ///< [m/s^2]
  Eigen::Vector3d gyro_bias = Eigen::Vector3d::Zero();           ///< [rad/s]
  Eigen::Vector3d gravity = -9.81 * Eigen::Vector3d::UnitZ();    ///< in the world [m/s^2]
  Eigen::Vector3d force = Eigen::Vector3d::Zero();               ///< specific, body axes [m/s^2]
  Eigen::Vector3d rate = Eigen::Vector3d::Zero();                ///< body axes [rad/s]
};

/// Blocks of the error state, three entries each; the rotation is disturbed on the right.
struct Error {
  static constexpr int kRotation = 0;
  static constexpr int kPosition = 3;
  static constexpr int kVelocity = 6;
  static constexpr int kAccelerometerBias = 9;
  static constexpr int kGyroBias = 12;
  static constexpr int kGravity = 15;
  static constexpr int kForce = 18;
  static constexpr int kRate = 21;
  static constexpr int kSize = 24;
  static constexpr int kPose = 6;  ///< a point depends on the blocks before the velocity
};

using ErrorVector = Eigen::Matrix<double, Error::kSize, 1>;
using ErrorMatrix = Eigen::Matrix<double, Error::kSize, Error::kSize>;

/// State and covariance of its error.
struct Belief {
  State state;
  ErrorMatrix covariance = ErrorMatrix::Identity();
};

/// The 3x3 block of two blocks of the error state.
inline Eigen::Matrix3d part(const ErrorMatrix& matrix, int row, int column) {
  return matrix.block<3, 3>(row, column);
}

}  // namespace aims::leg_kilo
