// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "core/lie.hpp"

namespace aims::fast_lio2 {

/// State of the filter. The world is the IMU's frame at the start, so gravity is a vector in it.
struct State {
  Pose T_world_body;                                             ///< of the IMU
  Pose T_body_lidar;                                             ///< extrinsic
  Eigen::Vector3d velocity = Eigen::Vector3d::Zero();            ///< v_world_body [m/s]
  Eigen::Vector3d gyro_bias = Eigen::Vector3d::Zero();           ///< [rad/s]
  Eigen::Vector3d accelerometer_bias = Eigen::Vector3d::Zero();  ///< [m/s^2]
  Eigen::Vector3d gravity = -9.81 * Eigen::Vector3d::UnitZ();    ///< in the world, on S2 [m/s^2]
};

/// Blocks of the error state; rotations are disturbed on the right.
struct Error {
  static constexpr int kPosition = 0;
  static constexpr int kRotation = 3;
  static constexpr int kMountRotation = 6;
  static constexpr int kMountTranslation = 9;
  static constexpr int kVelocity = 12;
  static constexpr int kGyroBias = 15;
  static constexpr int kAccelerometerBias = 18;
  static constexpr int kGravity = 21;  ///< two tangential coordinates [rad]
  static constexpr int kSize = 23;
  static constexpr int kMeasured = 12;  ///< a point depends on the blocks before the velocity
};

using ErrorVector = Eigen::Matrix<double, Error::kSize, 1>;
using ErrorMatrix = Eigen::Matrix<double, Error::kSize, Error::kSize>;

/// Three entries of an error vector, from a block's first on.
inline auto part(ErrorVector& vector, int block) { return vector.segment<3>(block); }
inline auto part(const ErrorVector& vector, int block) { return vector.segment<3>(block); }

/// The 3x3 block of two blocks of three entries.
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

/// Whether every entry is finite.
bool is_finite(const State& x);

/// The derivative of minus(plus(origin, error + d), x) in d at d = 0, where x = plus(origin,
/// error): takes errors at `origin` to errors at `x`. It is the identity but for rotations and
/// gravity.
class Transport {
 public:
  Transport(const State& origin, const State& x, const ErrorVector& error);

  /// J v.
  ErrorVector operator*(const ErrorVector& vector) const;
  /// J M.
  ErrorMatrix operator*(ErrorMatrix matrix) const;
  /// M J^T.
  ErrorMatrix on_columns(const ErrorMatrix& matrix) const;
  /// J P J^T.
  ErrorMatrix of_covariance(const ErrorMatrix& covariance) const;

 private:
  Eigen::Matrix3d rotation_;
  Eigen::Matrix3d mount_rotation_;
  Eigen::Matrix2d gravity_;
};

}  // namespace aims::fast_lio2
