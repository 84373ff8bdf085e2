// SPDX-License-Identifier: BSD-3-Clause
#include "estimator/filter/imu_propagation.hpp"

namespace aims {

void describe(Fields& f, ImuPropagationConfig& c) {
  f.number("gravity", c.gravity, {"m/s^2", positive_up_to(1e5), "magnitude of gravity"});
  f.number("gyro_bias_walk", c.gyro_bias_walk,
           {"rad/s^2/sqrt(Hz)", positive_up_to(1e3), "random walk of the gyro bias"});
  f.number("accelerometer_bias_walk", c.accelerometer_bias_walk,
           {"m/s^3/sqrt(Hz)", positive_up_to(1e3), "random walk of the accelerometer bias"});
}

namespace {

/// Change of the state over one segment, relative to its attitude at the start.
struct Increment {
  Eigen::Vector3d angle;     ///< rotation vector of the step [rad]
  Eigen::Vector3d force;     ///< specific force without bias [m/s^2]
  Eigen::Vector3d velocity;  ///< change due to the force, body axes at the start [m/s]
  Eigen::Vector3d position;  ///< change due to the force, body axes at the start [m]
};

/// Second integral of Exp(phi t) over t in [0, 1], as a series: one IMU step turns by a small
/// angle.
Eigen::Matrix3d double_integral(const Eigen::Vector3d& phi) {
  const Eigen::Matrix3d S = hat(phi);
  return 0.5 * Eigen::Matrix3d::Identity() + S / 6.0 + S * S / 24.0;
}

Increment increment(const NominalState& state, const InertialSegment& segment, double dt) {
  Increment step;
  step.angle = (segment.angular_velocity - state.gyro_bias) * dt;
  step.force = segment.specific_force - state.accelerometer_bias;
  step.velocity = so3_right_jacobian(-step.angle) * step.force * dt;
  step.position = double_integral(step.angle) * step.force * (dt * dt);
  return step;
}

}  // namespace

NominalState propagate_state(const NominalState& state, const InertialSegment& segment, double dt,
                             double gravity) {
  const Increment step = increment(state, segment, dt);
  const Eigen::Vector3d g(0.0, 0.0, -gravity);
  NominalState next = state;
  next.rotation = (state.rotation * so3_exp(step.angle)).normalized();
  next.velocity += state.rotation * step.velocity + g * dt;
  next.position += state.velocity * dt + state.rotation * step.position + 0.5 * g * dt * dt;
  return next;
}

ErrorMatrix propagation_jacobian(const NominalState& state, const InertialSegment& segment,
                                 double dt) {
  using E = ErrorState;
  const Increment step = increment(state, segment, dt);
  const Eigen::Matrix3d R = state.rotation.toRotationMatrix();
  const Eigen::Matrix3d force = hat(step.force);
  ErrorMatrix F = ErrorMatrix::Identity();
  block(F, E::kRotation, E::kRotation) = so3_exp(-step.angle).toRotationMatrix();
  block(F, E::kRotation, E::kGyroBias) = -so3_right_jacobian(step.angle) * dt;
  block(F, E::kVelocity, E::kRotation) = -R * hat(step.velocity);
  block(F, E::kVelocity, E::kGyroBias) = R * force * (dt * dt / 2.0);
  block(F, E::kVelocity, E::kAccelerometerBias) = -R * so3_right_jacobian(-step.angle) * dt;
  block(F, E::kPosition, E::kRotation) = -R * hat(step.position);
  block(F, E::kPosition, E::kVelocity) = Eigen::Matrix3d::Identity() * dt;
  block(F, E::kPosition, E::kGyroBias) = R * force * (dt * dt * dt / 6.0);
  block(F, E::kPosition, E::kAccelerometerBias) = -R * double_integral(step.angle) * (dt * dt);
  return F;
}

ErrorMatrix propagation_noise(const ImuPropagationConfig& config, const ImuNoiseDensity& white,
                              double dt) {
  using E = ErrorState;
  const Eigen::Matrix3d I = Eigen::Matrix3d::Identity();
  const double gyro_density = white.gyro * white.gyro;
  const double force_density = white.accelerometer * white.accelerometer;
  ErrorMatrix Q = ErrorMatrix::Zero();
  block(Q, E::kRotation, E::kRotation) = I * (gyro_density * dt);
  block(Q, E::kVelocity, E::kVelocity) = I * (force_density * dt);
  block(Q, E::kPosition, E::kPosition) = I * (force_density * dt * dt * dt / 3.0);
  block(Q, E::kPosition, E::kVelocity) = I * (force_density * dt * dt / 2.0);
  block(Q, E::kVelocity, E::kPosition) = I * (force_density * dt * dt / 2.0);
  block(Q, E::kGyroBias, E::kGyroBias) = I * (config.gyro_bias_walk * config.gyro_bias_walk * dt);
  block(Q, E::kAccelerometerBias, E::kAccelerometerBias) =
      I * (config.accelerometer_bias_walk * config.accelerometer_bias_walk * dt);
  return Q;
}

Belief propagate(const Belief& belief, const InertialSegment& segment, double dt,
                 const ImuPropagationConfig& config) {
  // Only rotation, position and velocity change, from themselves and the inertial biases.
  constexpr int kChanged = ErrorState::kGyroBias.offset;
  constexpr int kUsed = ErrorState::kMotionSize;
  const Eigen::Matrix<double, kChanged, kUsed> F =
      propagation_jacobian(belief.state, segment, dt).topLeftCorner<kChanged, kUsed>();
  ErrorMatrix covariance = belief.covariance;
  covariance.topRows<kChanged>() = F * belief.covariance.topRows<kUsed>();
  covariance.leftCols<kChanged>() = (covariance.leftCols<kUsed>() * F.transpose()).eval();
  covariance += propagation_noise(config, segment.noise, dt);
  return {propagate_state(belief.state, segment, dt, config.gravity),
          0.5 * (covariance + covariance.transpose())};
}

}  // namespace aims
