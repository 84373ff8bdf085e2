// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "core/lie.hpp"
#include "estimator/baselines/points/error_blocks.hpp"

namespace aims::fast_lio2 {

// The sphere of vectors of one length, on which gravity lies: two tangential coordinates u [rad],
// after Hertzberg, Wagner, Frese, Schroeder (Information Fusion 14, 2013) and He, Xu, Zhang
// (arXiv 2102.03804). `g` is any vector of positive length.

using Matrix32 = Eigen::Matrix<double, 3, 2>;
using Matrix23 = Eigen::Matrix<double, 2, 3>;

/// Two orthonormal columns perpendicular to `g`; smooth but at g along -x, where gravity of a
/// standing robot is not.
Matrix32 sphere_basis(const Eigen::Vector3d& g);

/// g [+] u: `g` turned by the rotation vector B(g) u.
Eigen::Vector3d sphere_plus(const Eigen::Vector3d& g, const Eigen::Vector2d& u);

/// The u with sphere_plus(from, u) = to.
Eigen::Vector2d sphere_minus(const Eigen::Vector3d& to, const Eigen::Vector3d& from);

/// Derivative of sphere_minus(y, g) in y at y = g: a change of the vector in tangential
/// coordinates.
Matrix23 sphere_minus_jacobian(const Eigen::Vector3d& g);

/// Derivative of sphere_plus(g, u) in u.
Matrix32 sphere_plus_jacobian(const Eigen::Vector3d& g, const Eigen::Vector2d& u);

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

using points::part;

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
