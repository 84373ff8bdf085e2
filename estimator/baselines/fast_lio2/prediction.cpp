// SPDX-License-Identifier: BSD-3-Clause
#include "estimator/baselines/fast_lio2/prediction.hpp"

#include "estimator/baselines/fast_lio2/state.hpp"

namespace aims::fast_lio2 {

void describe(Fields& f, ProcessNoise& c) {
  const std::string source = "published program, config/velodyne.yaml";
  const Range range = positive_up_to(1e6);
  f.number("gyro", c.gyro, {"rad^2/s^2", range, "variance of the angular rate", source});
  f.number("accelerometer", c.accelerometer,
           {"m^2/s^4", range, "variance of the specific force", source});
  f.number("gyro_bias", c.gyro_bias,
           {"rad^2/s^4", range, "variance of the drift of the gyro's bias", source});
  f.number("accelerometer_bias", c.accelerometer_bias,
           {"m^2/s^6", range, "variance of the drift of the accelerometer's bias", source});
}

State predicted(const State& x, const Inertial& input, double dt) {
  State y = x;
  const Eigen::Vector3d force = input.force - x.accelerometer_bias;
  y.T_world_body.translation += dt * x.velocity;
  y.T_world_body.rotation =
      (x.T_world_body.rotation * so3_exp(dt * (input.rate - x.gyro_bias))).normalized();
  y.velocity += dt * (x.T_world_body.rotation * force + x.gravity);
  return y;
}

ErrorMatrix prediction_jacobian(const State& x, const Inertial& input, double dt) {
  using E = Error;
  const Eigen::Matrix3d R = x.T_world_body.R();
  const Eigen::Vector3d angle = dt * (input.rate - x.gyro_bias);
  ErrorMatrix F = ErrorMatrix::Identity();
  part(F, E::kPosition, E::kVelocity) = dt * Eigen::Matrix3d::Identity();
  part(F, E::kRotation, E::kRotation) = so3_exp(-angle).toRotationMatrix();
  part(F, E::kRotation, E::kGyroBias) = -dt * so3_right_jacobian(angle);
  part(F, E::kVelocity, E::kRotation) = -dt * R * hat(input.force - x.accelerometer_bias);
  part(F, E::kVelocity, E::kAccelerometerBias) = -dt * R;
  F.block<3, 2>(E::kVelocity, E::kGravity) =
      dt * sphere_plus_jacobian(x.gravity, Eigen::Vector2d::Zero());
  return F;
}

ErrorMatrix prediction_noise(const State& x, const Inertial& input, double dt,
                             const ProcessNoise& noise) {
  using E = Error;
  const Eigen::Matrix3d J = so3_right_jacobian(dt * (input.rate - x.gyro_bias));
  const double dt2 = dt * dt;
  ErrorMatrix Q = ErrorMatrix::Zero();
  part(Q, E::kRotation, E::kRotation) = dt2 * noise.gyro * J * J.transpose();
  part(Q, E::kVelocity, E::kVelocity).diagonal().setConstant(dt2 * noise.accelerometer);
  part(Q, E::kGyroBias, E::kGyroBias).diagonal().setConstant(dt2 * noise.gyro_bias);
  part(Q, E::kAccelerometerBias, E::kAccelerometerBias)
      .diagonal()
      .setConstant(dt2 * noise.accelerometer_bias);
  return Q;
}

Belief predicted(const Belief& belief, const Inertial& input, double dt,
                 const ProcessNoise& noise) {
  const ErrorMatrix F = prediction_jacobian(belief.state, input, dt);
  return {predicted(belief.state, input, dt),
          F * belief.covariance * F.transpose() + prediction_noise(belief.state, input, dt, noise)};
}

}  // namespace aims::fast_lio2
