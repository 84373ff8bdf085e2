// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>

#include "core/lie.hpp"

namespace aims::lins {

/// Length of gravity [m/s^2].
inline constexpr double kGravity = 9.81;

/// State relative to the LiDAR at the last scan (Qin et al., LINS, ICRA 2020, section III).
struct State {
  Pose motion;                                                   ///< T_last_present
  Eigen::Vector3d velocity = Eigen::Vector3d::Zero();            ///< axes of the last scan [m/s]
  Eigen::Vector3d accelerometer_bias = Eigen::Vector3d::Zero();  ///< [m/s^2]
  Eigen::Vector3d gyro_bias = Eigen::Vector3d::Zero();           ///< [rad/s]
  /// In axes of the last scan [m/s^2].
  Eigen::Vector3d gravity = -kGravity * Eigen::Vector3d::UnitZ();
};

/// Blocks of the error state; the rotation is disturbed on the right.
struct Error {
  static constexpr int kPosition = 0;
  static constexpr int kVelocity = 3;
  static constexpr int kRotation = 6;
  static constexpr int kAccelerometerBias = 9;
  static constexpr int kGyroBias = 12;
  static constexpr int kGravity = 15;
  static constexpr int kSize = 18;
};

using ErrorVector = Eigen::Matrix<double, Error::kSize, 1>;
using ErrorMatrix = Eigen::Matrix<double, Error::kSize, Error::kSize>;

/// Three entries of an error vector, from a block's first on.
inline auto part(ErrorVector& vector, int block) { return vector.segment<3>(block); }
inline auto part(const ErrorVector& vector, int block) { return vector.segment<3>(block); }

/// The 3x3 block of two blocks.
inline auto part(ErrorMatrix& matrix, int row, int column) {
  return matrix.block<3, 3>(row, column);
}
inline auto part(const ErrorMatrix& matrix, int row, int column) {
  return matrix.block<3, 3>(row, column);
}

/// x [+] error.
State plus(const State& x, const ErrorVector& error);

/// The error with plus(from, error) = to.
ErrorVector minus(const State& to, const State& from);

/// State and covariance.
struct Belief {
  State state;
  ErrorMatrix covariance = ErrorMatrix::Zero();
};

bool is_finite(const Belief& belief);

/// Orientation of the LiDAR in a level frame with the heading of `R_world_lidar` and the direction
/// of gravity `gravity` in LiDAR axes.
Eigen::Quaterniond levelled(const Eigen::Quaterniond& R_world_lidar,
                            const Eigen::Vector3d& gravity);

/// The belief relative to the present LiDAR: no motion, without uncertainty; velocity in its axes.
/// Gravity follows likewise with `turn_gravity`; else only its covariance does, as in the published
/// program, which turns gravity by the motion that it has just cleared.
Belief rebased(const Belief& belief, bool turn_gravity);

}  // namespace aims::lins
