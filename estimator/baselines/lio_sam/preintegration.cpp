// SPDX-License-Identifier: BSD-3-Clause
#include "estimator/baselines/lio_sam/preintegration.hpp"

#include <utility>

namespace aims::lio_sam {

namespace {

/// Covariance after a step, before the delta moves.
void propagate_covariance(Preintegration& motion, const Eigen::Vector3d& rate,
                          const Eigen::Vector3d& force, double step, const ImuNoiseConfig& noise) {
  const Eigen::Matrix3d R = motion.delta.rotation.toRotationMatrix();
  const Eigen::Matrix3d turned = R * hat(force);
  Matrix9 F = Matrix9::Identity();
  F.block<3, 3>(kRotation, kRotation) = so3_exp(-rate * step).toRotationMatrix();
  F.block<3, 3>(kVelocity, kRotation) = -turned * step;
  F.block<3, 3>(kPosition, kRotation) = -0.5 * turned * step * step;
  F.block<3, 3>(kPosition, kVelocity) = step * Eigen::Matrix3d::Identity();
  Eigen::Matrix<double, 9, 3> by_force = Eigen::Matrix<double, 9, 3>::Zero();
  by_force.middleRows<3>(kVelocity) = R * step;
  by_force.middleRows<3>(kPosition) = 0.5 * R * step * step;
  const Eigen::Matrix3d by_rate = so3_right_jacobian(rate * step) * step;
  motion.covariance = F * motion.covariance * F.transpose();
  motion.covariance +=
      noise.accelerometer * noise.accelerometer / step * by_force * by_force.transpose();
  motion.covariance.block<3, 3>(kRotation, kRotation) +=
      noise.gyro * noise.gyro / step * by_rate * by_rate.transpose();
  motion.covariance.block<3, 3>(kPosition, kPosition).diagonal().array() +=
      noise.integration * noise.integration * step;
}

/// Derivatives in the bias after a step, before the delta moves.
void propagate_bias_jacobians(Preintegration& motion, const Eigen::Vector3d& rate,
                              const Eigen::Vector3d& force, double step) {
  const Eigen::Matrix3d R = motion.delta.rotation.toRotationMatrix();
  const Eigen::Matrix3d turned = R * hat(force) * motion.rotation_by_gyro;
  motion.position_by_accelerometer +=
      motion.velocity_by_accelerometer * step - 0.5 * R * step * step;
  motion.position_by_gyro += motion.velocity_by_gyro * step - 0.5 * turned * step * step;
  motion.velocity_by_accelerometer -= R * step;
  motion.velocity_by_gyro -= turned * step;
  motion.rotation_by_gyro = so3_exp(-rate * step).toRotationMatrix() * motion.rotation_by_gyro -
                            so3_right_jacobian(rate * step) * step;
}

}  // namespace

void describe(Fields& f, ImuNoiseConfig& c) {
  const Range positive = positive_up_to(1e3);
  f.number("accelerometer", c.accelerometer,
           {"m/s^2/sqrt(Hz)", positive, "density of the accelerometer's noise", "imuAccNoise"});
  f.number("gyro", c.gyro,
           {"rad/s/sqrt(Hz)", positive, "density of the gyro's noise", "imuGyrNoise"});
  f.number("accelerometer_bias", c.accelerometer_bias,
           {"m/s^2/sqrt(s)", positive, "random walk of the accelerometer's bias", "imuAccBiasN"});
  f.number("gyro_bias", c.gyro_bias,
           {"rad/s/sqrt(s)", positive, "random walk of the gyro's bias", "imuGyrBiasN"});
  f.number("integration", c.integration,
           {"m/sqrt(s)", positive, "of the position, from integrating velocities"});
}

void integrate(Preintegration& motion, const Eigen::Vector3d& rate, const Eigen::Vector3d& force,
               double step, const ImuNoiseConfig& noise) {
  const Eigen::Vector3d unbiased_rate = rate - motion.bias.gyro;
  const Eigen::Vector3d unbiased_force = force - motion.bias.accelerometer;
  propagate_covariance(motion, unbiased_rate, unbiased_force, step, noise);
  propagate_bias_jacobians(motion, unbiased_rate, unbiased_force, step);
  MotionDelta& delta = motion.delta;
  const Eigen::Vector3d acceleration = delta.rotation * unbiased_force;
  delta.position += delta.velocity * step + 0.5 * acceleration * step * step;
  delta.velocity += acceleration * step;
  delta.rotation = (delta.rotation * so3_exp(unbiased_rate * step)).normalized();
  motion.duration += step;
}

MotionDelta corrected(const Preintegration& motion, const ImuBias& bias) {
  const Eigen::Vector3d gyro = bias.gyro - motion.bias.gyro;
  const Eigen::Vector3d accelerometer = bias.accelerometer - motion.bias.accelerometer;
  MotionDelta delta = motion.delta;
  delta.rotation = delta.rotation * so3_exp(motion.rotation_by_gyro * gyro);
  delta.velocity +=
      motion.velocity_by_gyro * gyro + motion.velocity_by_accelerometer * accelerometer;
  delta.position +=
      motion.position_by_gyro * gyro + motion.position_by_accelerometer * accelerometer;
  return delta;
}

NavState predicted(const NavState& state, const Preintegration& motion, const ImuBias& bias,
                   double gravity) {
  const MotionDelta delta = corrected(motion, bias);
  const double t = motion.duration;
  const Eigen::Vector3d g(0.0, 0.0, -gravity);
  const Eigen::Quaterniond& R = state.T_map_imu.rotation;
  NavState next;
  next.T_map_imu.rotation = (R * delta.rotation).normalized();
  next.velocity = state.velocity + g * t + R * delta.velocity;
  next.T_map_imu.translation =
      state.T_map_imu.translation + state.velocity * t + 0.5 * g * t * t + R * delta.position;
  return next;
}

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
