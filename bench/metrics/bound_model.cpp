// SPDX-License-Identifier: BSD-3-Clause
#include "bench/metrics/bound_model.hpp"

#include <algorithm>
#include <cmath>

namespace aims::bound_model {
namespace {

constexpr double kGravity = 9.81;      ///< [m/s^2]
constexpr double kMovingSpeed = 0.05;  ///< above it the initial speed is unknown [m/s]
constexpr double kUnknownSpeed = 1.0;  ///< prior standard deviation of an unknown speed [m/s]

}  // namespace

using Eigen::Matrix3d;
using Eigen::Vector3d;

Matrix initial_covariance(const TrueMotion& start, const BoundParameters& parameters) {
  const InitialKnowledge& known = parameters.initial;
  const auto squared = [](double sigma) { return sigma * sigma; };
  Matrix P = Matrix::Zero();
  // Rotation errors are in body axes; heading is the world's z axis seen from the body.
  const Vector3d up = start.T_world_body.rotation.conjugate() * Vector3d::UnitZ();
  P.block<3, 3>(kRotation, kRotation) =
      squared(known.tilt_sigma) * (Matrix3d::Identity() - up * up.transpose()) +
      squared(known.heading_sigma) * up * up.transpose();
  const bool moving = start.velocity.norm() > kMovingSpeed;
  const auto fill = [&P](Offset offset, double variance) {
    P.block<3, 3>(offset, offset) = variance * Matrix3d::Identity();
  };
  fill(kPosition, squared(known.position_sigma));
  fill(kVelocity, squared(moving ? kUnknownSpeed : known.velocity_sigma));
  fill(kGyro, squared(parameters.gyro.bias_sigma));
  fill(kForce, squared(parameters.accelerometer.bias_sigma));
  P(kScale, kScale) = squared(parameters.legs.scale_sigma);
  return P;
}

Matrix transition(const TrueMotion& a, const TrueMotion& b, double dt) {
  const Matrix3d R = a.T_world_body.R();
  const Vector3d turn = so3_log(a.T_world_body.rotation.conjugate() * b.T_world_body.rotation);
  // Specific force over the step, in the body's axes at its start: as the true motion demands.
  const Vector3d gained = R.transpose() * (b.velocity - a.velocity + Vector3d(0, 0, kGravity * dt));
  const Vector3d moved =
      R.transpose() * (b.T_world_body.translation - a.T_world_body.translation - a.velocity * dt +
                       Vector3d(0, 0, 0.5 * kGravity * dt * dt));
  Matrix F = Matrix::Identity();
  F.block<3, 3>(kRotation, kRotation) = so3_exp(-turn).toRotationMatrix();
  F.block<3, 3>(kRotation, kGyro) = -dt * so3_right_jacobian(turn);
  F.block<3, 3>(kVelocity, kRotation) = -R * hat(gained);
  F.block<3, 3>(kVelocity, kGyro) = R * hat(gained) * (0.5 * dt);
  F.block<3, 3>(kVelocity, kForce) = -R * dt;
  F.block<3, 3>(kPosition, kRotation) = -R * hat(moved);
  F.block<3, 3>(kPosition, kVelocity) = Matrix3d::Identity() * dt;
  F.block<3, 3>(kPosition, kGyro) = R * hat(moved) * (dt / 3.0);
  F.block<3, 3>(kPosition, kForce) = -R * (0.5 * dt * dt);
  return F;
}

Matrix step_noise(const BoundParameters& parameters, double dt) {
  const auto density = [](double sigma) { return sigma * sigma; };
  const double force = density(parameters.accelerometer.noise_density);
  Matrix Q = Matrix::Zero();
  const auto fill = [&Q](Offset row, Offset column, double value) {
    Q.block<3, 3>(row, column) = value * Matrix3d::Identity();
  };
  fill(kRotation, kRotation, density(parameters.gyro.noise_density) * dt);
  fill(kVelocity, kVelocity, force * dt);
  fill(kPosition, kPosition, force * dt * dt * dt / 3.0);
  fill(kPosition, kVelocity, force * dt * dt / 2.0);
  fill(kVelocity, kPosition, force * dt * dt / 2.0);
  fill(kGyro, kGyro, density(parameters.gyro.bias_walk) * dt);
  fill(kForce, kForce, density(parameters.accelerometer.bias_walk) * dt);
  return Q;
}

Matrix leg_information(const TrueMotion& at, const BoundParameters& parameters, double dt) {
  const LegErrors& legs = parameters.legs;
  const Matrix3d R_base_body = parameters.T_body_base.R().transpose();
  const Matrix3d R_body_world = at.T_world_body.R().transpose();
  const Vector3d& lever = parameters.T_body_base.translation;
  const Vector3d velocity = R_body_world * at.velocity;
  Eigen::Matrix<double, 3, kSize> H = Eigen::Matrix<double, 3, kSize>::Zero();
  H.block<3, 3>(0, kRotation) = R_base_body * hat(velocity);
  H.block<3, 3>(0, kVelocity) = R_base_body * R_body_world;
  H.block<3, 3>(0, kGyro) = R_base_body * hat(lever);
  H.col(kScale) = R_base_body * (velocity + at.angular_velocity.cross(lever));
  const double weight = legs.packets_per_second * dt / (legs.velocity_sigma * legs.velocity_sigma);
  return weight * H.transpose() * H;
}

PoseRows pose_rows(const Pose& T_world_body) {
  PoseRows H = PoseRows::Zero();
  H.block<3, 3>(0, kRotation) = Matrix3d::Identity();
  H.block<3, 3>(3, kPosition) = T_world_body.R().transpose();
  return H;
}

PosteriorBound bound_at(const Matrix& P, const TrueMotion& at) {
  PosteriorBound bound;
  bound.stamp = at.stamp;
  bound.position = P.block<3, 3>(kPosition, kPosition);
  const Eigen::Quaterniond heading = yaw_rotation(yaw_of(at.T_world_body.rotation));
  bound.longitudinal = bound_along(bound, heading * Vector3d::UnitX());
  bound.lateral = bound_along(bound, heading * Vector3d::UnitY());
  bound.vertical = bound_along(bound, Vector3d::UnitZ());
  const Vector3d up = at.T_world_body.rotation.conjugate() * Vector3d::UnitZ();
  bound.heading = std::sqrt(std::max(0.0, up.dot(P.block<3, 3>(kRotation, kRotation) * up)));
  bound.leg_scale = std::sqrt(std::max(0.0, P(kScale, kScale)));
  return bound;
}

TrueMotion between(const TrueMotion& a, const TrueMotion& b, Time stamp) {
  const double fraction =
      static_cast<double>(stamp - a.stamp) / static_cast<double>(b.stamp - a.stamp);
  return {stamp, interpolate(a.T_world_body, b.T_world_body, fraction),
          a.velocity + fraction * (b.velocity - a.velocity),
          a.angular_velocity + fraction * (b.angular_velocity - a.angular_velocity)};
}

}  // namespace aims::bound_model
