// SPDX-License-Identifier: BSD-3-Clause
#include "estimator/baselines/lio_sam/factors.hpp"

#include <utility>

namespace aims::lio_sam {
namespace {

using Eigen::Matrix3d;
using Eigen::MatrixXd;
using Eigen::Vector3d;
using Eigen::VectorXd;
using pose_graph::Linearization;

VectorXd stacked(const ImuBias& bias) {
  VectorXd entries(6);
  entries << bias.accelerometer, bias.gyro;
  return entries;
}

/// States, bias and motion of an IMU factor.
struct ImuResidual {
  Pose from;
  Vector3d velocity_from;
  Pose to;
  Vector3d velocity_to;
  ImuBias bias;
  const Preintegration& motion;
  Vector3d g;

  Vector3d velocity_change() const {
    return from.rotation.conjugate() * (velocity_to - velocity_from - g * motion.duration);
  }
  Vector3d position_change() const {
    const double t = motion.duration;
    return from.rotation.conjugate() *
           (to.translation - from.translation - velocity_from * t - 0.5 * g * t * t);
  }
};

/// Fills the rows of the rotation.
void linearize_rotation(const ImuResidual& r, const MotionDelta& delta, Linearization& result) {
  const Matrix3d R_to_from = (r.to.rotation.conjugate() * r.from.rotation).toRotationMatrix();
  const Eigen::Quaterniond error =
      delta.rotation.conjugate() * r.from.rotation.conjugate() * r.to.rotation;
  const Vector3d angle = so3_log(error);
  const Matrix3d inverse = so3_right_jacobian_inverse(angle);
  const Vector3d by_bias = r.motion.rotation_by_gyro * (r.bias.gyro - r.motion.bias.gyro);
  result.residual.segment<3>(kRotation) = angle;
  result.jacobians[0].block<3, 3>(kRotation, 0) = -inverse * R_to_from;
  result.jacobians[2].block<3, 3>(kRotation, 0) = inverse;
  result.jacobians[4].block<3, 3>(kRotation, 3) = -inverse * error.toRotationMatrix().transpose() *
                                                  so3_right_jacobian(by_bias) *
                                                  r.motion.rotation_by_gyro;
}

void linearize_velocity(const ImuResidual& r, const MotionDelta& delta, Linearization& result) {
  const Matrix3d R_from_map = r.from.R().transpose();
  result.residual.segment<3>(kVelocity) = r.velocity_change() - delta.velocity;
  result.jacobians[0].block<3, 3>(kVelocity, 0) = hat(r.velocity_change());
  result.jacobians[1].block<3, 3>(kVelocity, 0) = -R_from_map;
  result.jacobians[3].block<3, 3>(kVelocity, 0) = R_from_map;
  result.jacobians[4].block<3, 3>(kVelocity, 0) = -r.motion.velocity_by_accelerometer;
  result.jacobians[4].block<3, 3>(kVelocity, 3) = -r.motion.velocity_by_gyro;
}

void linearize_position(const ImuResidual& r, const MotionDelta& delta, Linearization& result) {
  const Matrix3d R_from_map = r.from.R().transpose();
  result.residual.segment<3>(kPosition) = r.position_change() - delta.position;
  result.jacobians[0].block<3, 3>(kPosition, 0) = hat(r.position_change());
  result.jacobians[0].block<3, 3>(kPosition, 3) = -Matrix3d::Identity();
  result.jacobians[1].block<3, 3>(kPosition, 0) = -R_from_map * r.motion.duration;
  result.jacobians[2].block<3, 3>(kPosition, 3) = R_from_map * r.to.R();
  result.jacobians[4].block<3, 3>(kPosition, 0) = -r.motion.position_by_accelerometer;
  result.jacobians[4].block<3, 3>(kPosition, 3) = -r.motion.position_by_gyro;
}

Linearization linearized(const ImuResidual& r) {
  Linearization result;
  result.residual = VectorXd::Zero(9);
  for (const int columns : {6, 3, 6, 3, 6}) result.jacobians.push_back(MatrixXd::Zero(9, columns));
  const MotionDelta delta = corrected(r.motion, r.bias);
  linearize_rotation(r, delta, result);
  linearize_velocity(r, delta, result);
  linearize_position(r, delta, result);
  return result;
}

}  // namespace

Factor velocity_prior(int velocity, const Vector3d& mean, const MatrixXd& sqrt_information) {
  return {{velocity}, sqrt_information, [mean](std::span<const Value> values) {
            return Linearization{std::get<Vector3d>(values[0]) - mean, {MatrixXd::Identity(3, 3)}};
          }};
}

Factor bias_prior(int bias, const ImuBias& mean, const MatrixXd& sqrt_information) {
  return {{bias}, sqrt_information, [mean](std::span<const Value> values) {
            return Linearization{stacked(std::get<ImuBias>(values[0])) - stacked(mean),
                                 {MatrixXd::Identity(6, 6)}};
          }};
}

Factor bias_walk(int from, int to, const MatrixXd& sqrt_information) {
  return {{from, to}, sqrt_information, [](std::span<const Value> values) {
            return Linearization{
                stacked(std::get<ImuBias>(values[1])) - stacked(std::get<ImuBias>(values[0])),
                {-MatrixXd::Identity(6, 6), MatrixXd::Identity(6, 6)}};
          }};
}

std::optional<Factor> imu_factor(const Key& from, const Key& to, const Preintegration& motion,
                                 double gravity) {
  const auto sqrt_information = pose_graph::sqrt_information_of(motion.covariance);
  if (!sqrt_information) return std::nullopt;
  return Factor{
      {from.pose, from.velocity, to.pose, to.velocity, from.bias},
      *sqrt_information,
      [motion, gravity](std::span<const Value> values) {
        return linearized({std::get<Pose>(values[0]), std::get<Vector3d>(values[1]),
                           std::get<Pose>(values[2]), std::get<Vector3d>(values[3]),
                           std::get<ImuBias>(values[4]), motion, Vector3d(0.0, 0.0, -gravity)});
      }};
}

}  // namespace aims::lio_sam
