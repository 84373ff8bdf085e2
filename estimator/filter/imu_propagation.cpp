// SPDX-License-Identifier: BSD-3-Clause
#include "estimator/filter/imu_propagation.hpp"

namespace aims {

void describe(Fields& f, ImuPropagationConfig& c) {
  f.number("gravity", c.gravity,
           {"m/s^2", positive_up_to(1e5), "magnitude of gravity", "9.78 to 9.83 by latitude"});
  f.number("gyro_bias_walk", c.gyro_bias_walk,
           {"rad/s^2/sqrt(Hz)", positive_up_to(1e3), "random walk of the gyro bias",
            "MEMS: 1.9e-5 in the ADIS16448 of EuRoC"});
  f.number("accelerometer_bias_walk", c.accelerometer_bias_walk,
           {"m/s^3/sqrt(Hz)", positive_up_to(1e3), "random walk of the accelerometer bias",
            "MEMS: 2e-4 in the example of Kalibr"});
}

namespace {

/// Entries of the error that one step changes: rotation, position and velocity; and all others.
constexpr int kMoved = ErrorState::kGyroBias.offset;
constexpr int kOthers = ErrorState::kSize - kMoved;

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

/// The blocks of the derivative of one step that are neither zero nor the identity.
struct MotionJacobian {
  Eigen::Matrix3d rotation_rotation, rotation_gyro;
  Eigen::Matrix3d position_rotation, position_gyro, position_accelerometer;
  Eigen::Matrix3d velocity_rotation, velocity_gyro, velocity_accelerometer;
  double dt;  ///< of the position by the velocity [s]
};

MotionJacobian motion_jacobian(const NominalState& state, const Increment& step, double dt) {
  const Eigen::Matrix3d R = state.rotation.toRotationMatrix();
  const Eigen::Matrix3d R_force = R * hat(step.force);
  MotionJacobian J;
  J.rotation_rotation = so3_exp(-step.angle).toRotationMatrix();
  J.rotation_gyro = -so3_right_jacobian(step.angle) * dt;
  J.velocity_rotation = -R * hat(step.velocity);
  J.velocity_gyro = R_force * (dt * dt / 2.0);
  J.velocity_accelerometer = -R * so3_right_jacobian(-step.angle) * dt;
  J.position_rotation = -R * hat(step.position);
  J.position_gyro = R_force * (dt * dt * dt / 6.0);
  J.position_accelerometer = -R * double_integral(step.angle) * (dt * dt);
  J.dt = dt;
  return J;
}

/// The first rows of F M, those of rotation, position and velocity, for a matrix M with as many
/// rows as the state of the motion. The other rows of F are those of the identity.
template <class Matrix>
auto moved_rows(const MotionJacobian& J, const Matrix& M) {
  using E = ErrorState;
  const auto rows = [&M](E::Block block) { return M.template middleRows<3>(block.offset); };
  const auto rotation = rows(E::kRotation);
  const auto gyro = rows(E::kGyroBias);
  const auto accelerometer = rows(E::kAccelerometerBias);
  Eigen::Matrix<double, kMoved, Matrix::ColsAtCompileTime> moved;
  moved.template middleRows<3>(E::kRotation.offset) =
      J.rotation_rotation.lazyProduct(rotation) + J.rotation_gyro.lazyProduct(gyro);
  moved.template middleRows<3>(E::kPosition.offset) =
      rows(E::kPosition) + J.dt * rows(E::kVelocity) + J.position_rotation.lazyProduct(rotation) +
      J.position_gyro.lazyProduct(gyro) + J.position_accelerometer.lazyProduct(accelerometer);
  moved.template middleRows<3>(E::kVelocity.offset) =
      rows(E::kVelocity) + J.velocity_rotation.lazyProduct(rotation) +
      J.velocity_gyro.lazyProduct(gyro) + J.velocity_accelerometer.lazyProduct(accelerometer);
  return moved;
}

/// Adds the noise of one step to the covariance.
void add_noise(ErrorMatrix& P, const ImuPropagationConfig& config, const ImuNoiseDensity& white,
               double dt) {
  using E = ErrorState;
  const auto add = [&P](E::Block row, E::Block column, double variance) {
    block(P, row, column).diagonal().array() += variance;
  };
  const double gyro_density = white.gyro * white.gyro;
  const double force_density = white.accelerometer * white.accelerometer;
  add(E::kRotation, E::kRotation, gyro_density * dt);
  add(E::kVelocity, E::kVelocity, force_density * dt);
  add(E::kPosition, E::kPosition, force_density * dt * dt * dt / 3.0);
  add(E::kPosition, E::kVelocity, force_density * dt * dt / 2.0);
  add(E::kVelocity, E::kPosition, force_density * dt * dt / 2.0);
  add(E::kGyroBias, E::kGyroBias, config.gyro_bias_walk * config.gyro_bias_walk * dt);
  add(E::kAccelerometerBias, E::kAccelerometerBias,
      config.accelerometer_bias_walk * config.accelerometer_bias_walk * dt);
}

/// The state after one step.
NominalState after(const NominalState& state, const Increment& step, double dt, double gravity) {
  const Eigen::Vector3d g(0.0, 0.0, -gravity);
  NominalState next = state;
  next.rotation = (state.rotation * so3_exp(step.angle)).normalized();
  next.velocity += state.rotation * step.velocity + g * dt;
  next.position += state.velocity * dt + state.rotation * step.position + 0.5 * g * dt * dt;
  return next;
}

}  // namespace

NominalState propagate_state(const NominalState& state, const InertialSegment& segment, double dt,
                             double gravity) {
  return after(state, increment(state, segment, dt), dt, gravity);
}

ErrorMatrix propagation_jacobian(const NominalState& state, const InertialSegment& segment,
                                 double dt) {
  using E = ErrorState;
  const MotionJacobian J = motion_jacobian(state, increment(state, segment, dt), dt);
  ErrorMatrix F = ErrorMatrix::Identity();
  block(F, E::kRotation, E::kRotation) = J.rotation_rotation;
  block(F, E::kRotation, E::kGyroBias) = J.rotation_gyro;
  block(F, E::kVelocity, E::kRotation) = J.velocity_rotation;
  block(F, E::kVelocity, E::kGyroBias) = J.velocity_gyro;
  block(F, E::kVelocity, E::kAccelerometerBias) = J.velocity_accelerometer;
  block(F, E::kPosition, E::kRotation) = J.position_rotation;
  block(F, E::kPosition, E::kVelocity) = J.dt * Eigen::Matrix3d::Identity();
  block(F, E::kPosition, E::kGyroBias) = J.position_gyro;
  block(F, E::kPosition, E::kAccelerometerBias) = J.position_accelerometer;
  return F;
}

ErrorMatrix propagation_noise(const ImuPropagationConfig& config, const ImuNoiseDensity& white,
                              double dt) {
  ErrorMatrix Q = ErrorMatrix::Zero();
  add_noise(Q, config, white, dt);
  return Q;
}

Belief propagate(const Belief& belief, const InertialSegment& segment, double dt,
                 const ImuPropagationConfig& config) {
  const Increment step = increment(belief.state, segment, dt);
  const MotionJacobian J = motion_jacobian(belief.state, step, dt);
  Belief next{after(belief.state, step, dt, config.gravity), belief.covariance};
  ErrorMatrix& P = next.covariance;
  // F P F^T: F leaves the columns of the biases and of all that follows as they are.
  const auto rows = moved_rows(J, belief.covariance);
  P.topRows<kMoved>() = rows;
  const Eigen::Matrix<double, kMoved, ErrorState::kMotionSize> used =
      rows.leftCols<ErrorState::kMotionSize>();
  const Eigen::Matrix<double, kMoved, kMoved> corner =
      moved_rows(J, Eigen::Matrix<double, ErrorState::kMotionSize, kMoved>(used.transpose()));
  P.topLeftCorner<kMoved, kMoved>() = 0.5 * (corner + corner.transpose());
  P.bottomLeftCorner<kOthers, kMoved>() = P.topRightCorner<kMoved, kOthers>().transpose();
  add_noise(P, config, segment.noise, dt);
  if (belief.excess) {
    const ErrorMatrix F = propagation_jacobian(belief.state, segment, dt);
    next.excess = F * *belief.excess * F.transpose();
  }
  return next;
}

}  // namespace aims
