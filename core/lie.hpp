// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

namespace aims {

/// Skew-symmetric matrix of a 3-vector: hat(a) * b = a x b.
Eigen::Matrix3d hat(const Eigen::Vector3d& a);

/// Rotation of the rotation vector `phi` [rad]: Exp: R^3 -> SO(3), as a unit quaternion.
Eigen::Quaterniond so3_exp(const Eigen::Vector3d& phi);

/// Rotation vector [rad] of the rotation `q`, of norm at most pi: Log: SO(3) -> R^3.
Eigen::Vector3d so3_log(const Eigen::Quaterniond& q);

/// Right Jacobian of SO(3): Exp(phi + d) ~ Exp(phi) Exp(J_r(phi) d).
Eigen::Matrix3d so3_right_jacobian(const Eigen::Vector3d& phi);

/// Inverse of the right Jacobian: Log(Exp(phi) Exp(d)) ~ phi + J_r^-1(phi) d.
Eigen::Matrix3d so3_right_jacobian_inverse(const Eigen::Vector3d& phi);

/// Rotation by the heading `yaw` [rad] about the z axis.
Eigen::Quaterniond yaw_rotation(double yaw);

/// Heading [rad] in (-pi, pi] of the body's x axis in the world's xy plane.
double yaw_of(const Eigen::Quaterniond& q);

/// Angle [rad] wrapped to (-pi, pi].
double wrap_angle(double angle);

/// Rigid transform: `T_a_b * p_b` are the coordinates in frame a of the point p_b in frame b.
struct Pose {
  Eigen::Quaterniond rotation = Eigen::Quaterniond::Identity();
  Eigen::Vector3d translation = Eigen::Vector3d::Zero();  ///< [m]

  /// Rotation as a 3x3 matrix.
  Eigen::Matrix3d R() const { return rotation.toRotationMatrix(); }
  Pose inverse() const;
  Pose operator*(const Pose& other) const;
  Eigen::Vector3d operator*(const Eigen::Vector3d& point) const {
    return rotation * point + translation;
  }
};

/// Pose between `a` (fraction 0) and `b` (1): linear in position, slerp in rotation.
Pose interpolate(const Pose& a, const Pose& b, double fraction);

}  // namespace aims
