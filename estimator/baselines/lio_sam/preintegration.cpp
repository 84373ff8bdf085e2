// SPDX-License-Identifier: BSD-3-Clause
#include "estimator/baselines/lio_sam/preintegration.hpp"

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

}  // namespace aims::lio_sam
