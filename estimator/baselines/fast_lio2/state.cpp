// SPDX-License-Identifier: BSD-3-Clause
#include "estimator/baselines/fast_lio2/state.hpp"

#include <cmath>
#include <numbers>

#include "core/lie.hpp"

namespace aims::fast_lio2 {

namespace {

/// Sines and remainders below this are zero [-].
constexpr double kTiny = 1e-11;

}  // namespace

Matrix32 sphere_basis(const Eigen::Vector3d& g) {
  const Eigen::Vector3d n = g.normalized();
  Matrix32 basis;
  if (1.0 + n.x() < kTiny) {
    basis << 0.0, 0.0, -1.0, 0.0, 0.0, 1.0;
    return basis;
  }
  // The rotation that takes the x axis to n, applied to the y and the z axis.
  const double scale = 1.0 / (1.0 + n.x());
  basis << -n.y(), -n.z(),                                  //
      1.0 - n.y() * n.y() * scale, -n.y() * n.z() * scale,  //
      -n.y() * n.z() * scale, 1.0 - n.z() * n.z() * scale;
  return basis;
}

Eigen::Vector3d sphere_plus(const Eigen::Vector3d& g, const Eigen::Vector2d& u) {
  return so3_exp(sphere_basis(g) * u) * g;
}

Eigen::Vector2d sphere_minus(const Eigen::Vector3d& to, const Eigen::Vector3d& from) {
  const Eigen::Vector3d axis = from.cross(to);
  const double sine = axis.norm();
  const double cosine = from.dot(to);
  const double scale = from.norm() * to.norm();
  if (sine < kTiny * scale) {
    // Opposite vectors: any axis of the tangential plane, by half a turn.
    return cosine > 0.0 ? Eigen::Vector2d::Zero() : Eigen::Vector2d(std::numbers::pi, 0.0);
  }
  return std::atan2(sine, cosine) / sine * (sphere_basis(from).transpose() * axis);
}

Matrix23 sphere_minus_jacobian(const Eigen::Vector3d& g) {
  return sphere_basis(g).transpose() * hat(g) / g.squaredNorm();
}

Matrix32 sphere_plus_jacobian(const Eigen::Vector3d& g, const Eigen::Vector2d& u) {
  const Matrix32 basis = sphere_basis(g);
  const Eigen::Vector3d phi = basis * u;
  return -so3_exp(phi).toRotationMatrix() * hat(g) * so3_right_jacobian(phi) * basis;
}

State plus(const State& x, const ErrorVector& error) {
  State y = x;
  y.T_world_body.translation += part(error, Error::kPosition);
  y.T_world_body.rotation =
      (x.T_world_body.rotation * so3_exp(part(error, Error::kRotation))).normalized();
  y.T_body_lidar.rotation =
      (x.T_body_lidar.rotation * so3_exp(part(error, Error::kMountRotation))).normalized();
  y.T_body_lidar.translation += part(error, Error::kMountTranslation);
  y.velocity += part(error, Error::kVelocity);
  y.gyro_bias += part(error, Error::kGyroBias);
  y.accelerometer_bias += part(error, Error::kAccelerometerBias);
  y.gravity = sphere_plus(x.gravity, error.segment<2>(Error::kGravity));
  return y;
}

ErrorVector minus(const State& to, const State& from) {
  ErrorVector error;
  const Pose& a = from.T_world_body;
  const Pose& b = to.T_world_body;
  part(error, Error::kPosition) = b.translation - a.translation;
  part(error, Error::kRotation) = so3_log(a.rotation.conjugate() * b.rotation);
  part(error, Error::kMountRotation) =
      so3_log(from.T_body_lidar.rotation.conjugate() * to.T_body_lidar.rotation);
  part(error, Error::kMountTranslation) =
      to.T_body_lidar.translation - from.T_body_lidar.translation;
  part(error, Error::kVelocity) = to.velocity - from.velocity;
  part(error, Error::kGyroBias) = to.gyro_bias - from.gyro_bias;
  part(error, Error::kAccelerometerBias) = to.accelerometer_bias - from.accelerometer_bias;
  error.segment<2>(Error::kGravity) = sphere_minus(to.gravity, from.gravity);
  return error;
}

bool is_finite(const State& x) {
  return x.T_world_body.translation.allFinite() && x.T_world_body.rotation.coeffs().allFinite() &&
         x.T_body_lidar.translation.allFinite() && x.T_body_lidar.rotation.coeffs().allFinite() &&
         x.velocity.allFinite() && x.gyro_bias.allFinite() && x.accelerometer_bias.allFinite() &&
         x.gravity.allFinite();
}

Transport::Transport(const State& origin, const State& x, const ErrorVector& error)
    : rotation_(so3_right_jacobian(part(error, Error::kRotation))),
      mount_rotation_(so3_right_jacobian(part(error, Error::kMountRotation))),
      gravity_(sphere_minus_jacobian(x.gravity) *
               sphere_plus_jacobian(origin.gravity, error.segment<2>(Error::kGravity))) {}

ErrorVector Transport::operator*(const ErrorVector& vector) const {
  ErrorVector result = vector;
  part(result, Error::kRotation) = rotation_ * part(vector, Error::kRotation);
  part(result, Error::kMountRotation) = mount_rotation_ * part(vector, Error::kMountRotation);
  result.segment<2>(Error::kGravity) = gravity_ * vector.segment<2>(Error::kGravity);
  return result;
}

ErrorMatrix Transport::operator*(ErrorMatrix matrix) const {
  matrix.middleRows<3>(Error::kRotation) =
      (rotation_ * matrix.middleRows<3>(Error::kRotation)).eval();
  matrix.middleRows<3>(Error::kMountRotation) =
      (mount_rotation_ * matrix.middleRows<3>(Error::kMountRotation)).eval();
  matrix.middleRows<2>(Error::kGravity) = (gravity_ * matrix.middleRows<2>(Error::kGravity)).eval();
  return matrix;
}

ErrorMatrix Transport::on_columns(const ErrorMatrix& matrix) const {
  return (*this * ErrorMatrix(matrix.transpose())).transpose();
}

ErrorMatrix Transport::of_covariance(const ErrorMatrix& covariance) const {
  return on_columns(*this * covariance);
}

}  // namespace aims::fast_lio2
