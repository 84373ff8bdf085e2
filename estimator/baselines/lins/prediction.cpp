// SPDX-License-Identifier: BSD-3-Clause
#include "estimator/baselines/lins/prediction.hpp"

namespace aims::lins {

void describe(Fields& f, ProcessNoise& c) {
  f.number("accelerometer", c.accelerometer,
           {"m/s^2", up_to(1e3), "standard deviation of the specific force"});
  f.number("gyro", c.gyro, {"rad/s", up_to(1e3), "standard deviation of the angular rate"});
  f.number("accelerometer_bias", c.accelerometer_bias,
           {"m/s^3", up_to(1e3), "standard deviation of the change of its bias"});
  f.number("gyro_bias", c.gyro_bias,
           {"rad/s^2", up_to(1e3), "standard deviation of the change of its bias"});
}

State predicted(const State& x, const Inertial& begin, const Inertial& end, double dt) {
  const auto acceleration = [&](const Eigen::Quaterniond& rotation, const Inertial& input) {
    const Eigen::Vector3d force = input.force - x.accelerometer_bias;
    return Eigen::Vector3d(rotation * force + x.gravity);
  };
  const Eigen::Vector3d rate = 0.5 * (begin.rate + end.rate) - x.gyro_bias;
  State next = x;
  next.motion.rotation = (x.motion.rotation * so3_exp(rate * dt)).normalized();
  const Eigen::Vector3d mean =
      0.5 * (acceleration(x.motion.rotation, begin) + acceleration(next.motion.rotation, end));
  next.motion.translation += dt * x.velocity + 0.5 * dt * dt * mean;
  next.velocity += dt * mean;
  return next;
}

ErrorMatrix prediction_jacobian(const State& after, const Inertial& end, double dt) {
  const Eigen::Matrix3d R = after.motion.R();
  ErrorMatrix A = ErrorMatrix::Zero();
  part(A, Error::kPosition, Error::kVelocity).setIdentity();
  part(A, Error::kVelocity, Error::kRotation) = -R * hat(end.force - after.accelerometer_bias);
  part(A, Error::kVelocity, Error::kAccelerometerBias) = -R;
  part(A, Error::kVelocity, Error::kGravity).setIdentity();
  part(A, Error::kRotation, Error::kRotation) = -hat(end.rate - after.gyro_bias);
  part(A, Error::kRotation, Error::kGyroBias) = -Eigen::Matrix3d::Identity();
  return ErrorMatrix::Identity() + A * dt + 0.5 * dt * dt * A * A;
}

ErrorMatrix prediction_noise(double dt, const ProcessNoise& noise) {
  ErrorVector deviations = ErrorVector::Zero();
  part(deviations, Error::kVelocity).setConstant(noise.accelerometer);
  part(deviations, Error::kRotation).setConstant(noise.gyro);
  part(deviations, Error::kAccelerometerBias).setConstant(noise.accelerometer_bias);
  part(deviations, Error::kGyroBias).setConstant(noise.gyro_bias);
  return (dt * deviations).cwiseAbs2().asDiagonal();
}

Belief predicted(const Belief& belief, const Inertial& begin, const Inertial& end, double dt,
                 const ProcessNoise& noise) {
  Belief next;
  next.state = predicted(belief.state, begin, end, dt);
  const ErrorMatrix F = prediction_jacobian(next.state, end, dt);
  const ErrorMatrix covariance = F * belief.covariance * F.transpose();
  next.covariance = 0.5 * (covariance + covariance.transpose()) + prediction_noise(dt, noise);
  return next;
}

}  // namespace aims::lins
