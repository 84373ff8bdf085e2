// SPDX-License-Identifier: BSD-3-Clause
#include "estimator/baselines/fast_lio2/state.hpp"

#include "estimator/baselines/fast_lio2/sphere.hpp"

namespace aims::fast_lio2 {

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
