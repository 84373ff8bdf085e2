// SPDX-License-Identifier: BSD-3-Clause
#include "estimator/baselines/leg_kilo/filter.hpp"

#include <Eigen/LU>

namespace aims::leg_kilo {

namespace {

/// Further from the start the state is of no use [m].
constexpr double kMaxDistance = 5e4;

/// Added to the innovation's variance when a point is alone [m^2].
constexpr double kSinglePointVariance = 1e-4;

/// M <- F M, row block by row block: F differs from the identity in three of them.
void advance_rows(ErrorMatrix& M, const State& x, double dt) {
  using E = Error;
  const Eigen::Matrix3d R = x.T_world_body.R();
  const auto rows = [&M](int block) { return M.middleRows<3>(block); };
  const Eigen::Matrix3d turn = so3_exp(-dt * x.rate).toRotationMatrix();
  const Eigen::Matrix3d lean = -dt * R * hat(x.force);
  rows(E::kPosition) += dt * rows(E::kVelocity);
  rows(E::kVelocity) += lean * rows(E::kRotation) + dt * rows(E::kGravity);
  rows(E::kVelocity).noalias() += (dt * R) * rows(E::kForce);
  rows(E::kRotation) = (turn * rows(E::kRotation)).eval() + dt * rows(E::kRate);
}

/// The update with the derivative in the first `N` entries of the error state.
template <class Jacobian>
Belief gain_update(const Belief& prior, const Eigen::VectorXd& innovation, const Jacobian& jacobian,
                   const Eigen::VectorXd& variance) {
  constexpr int N = Jacobian::ColsAtCompileTime;
  const auto& P = prior.covariance;
  const Eigen::Matrix<double, Error::kSize, Eigen::Dynamic> PHt =
      P.template leftCols<N>() * jacobian.transpose();
  Eigen::MatrixXd S = jacobian * PHt.template topRows<N>();
  S.diagonal() += variance;
  const Eigen::Matrix<double, Error::kSize, Eigen::Dynamic> K = PHt * S.inverse();
  const Eigen::Matrix<double, Eigen::Dynamic, Error::kSize> HP = jacobian * P.template topRows<N>();
  return {plus(prior.state, K * innovation), P - K * HP};
}

/// The same for one row of the pose.
Belief scalar_update(const Belief& prior, const PoseObservation& observation) {
  const auto& P = prior.covariance;
  const Eigen::Matrix<double, 1, Error::kPose> h = observation.jacobian.row(0);
  const ErrorVector PHt = P.leftCols<Error::kPose>() * h.transpose();
  const double S = h.dot(PHt.head<Error::kPose>()) + observation.variance(0) + kSinglePointVariance;
  const ErrorVector K = PHt / S;
  const Eigen::Matrix<double, 1, Error::kSize> HP = h * P.topRows<Error::kPose>();
  return {plus(prior.state, K * observation.innovation(0)), P - K * HP};
}

}  // namespace

void describe(Fields& f, ProcessNoise& c) {
  const std::string source = "published program, config/leg_fusion.yaml";
  const Range range = positive_up_to(1e9);
  f.number("velocity", c.velocity, {"m^2/s^4", range, "variance of the velocity's rate", source});
  f.number("force", c.force, {"m^2/s^6", range, "variance of the specific force's rate", source});
  f.number("rate", c.rate, {"rad^2/s^4", range, "variance of the angular rate's rate", source});
  f.number("accelerometer_bias", c.accelerometer_bias,
           {"m^2/s^6", range, "variance of the drift of the accelerometer's bias", source});
  f.number("gyro_bias", c.gyro_bias,
           {"rad^2/s^4", range, "variance of the drift of the gyro's bias", source});
}

Observation::Observation(Eigen::Index rows)
    : innovation(rows), jacobian(rows, Error::kSize), variance(rows) {
  jacobian.setZero();
}

State plus(const State& x, const ErrorVector& error) {
  using E = Error;
  State y = x;
  y.T_world_body.rotation =
      (x.T_world_body.rotation * so3_exp(error.segment<3>(E::kRotation))).normalized();
  y.T_world_body.translation += error.segment<3>(E::kPosition);
  y.velocity += error.segment<3>(E::kVelocity);
  y.accelerometer_bias += error.segment<3>(E::kAccelerometerBias);
  y.gyro_bias += error.segment<3>(E::kGyroBias);
  y.gravity += error.segment<3>(E::kGravity);
  y.force += error.segment<3>(E::kForce);
  y.rate += error.segment<3>(E::kRate);
  return y;
}

State predicted(const State& x, double dt) {
  State y = x;
  y.T_world_body.rotation = (x.T_world_body.rotation * so3_exp(dt * x.rate)).normalized();
  y.T_world_body.translation += dt * x.velocity;
  y.velocity += dt * (x.T_world_body.rotation * x.force + x.gravity);
  return y;
}

ErrorMatrix predicted_covariance(const ErrorMatrix& covariance, const State& x, double dt,
                                 const ProcessNoise& noise) {
  using E = Error;
  // F (F P)^T is the transpose of F P F^T.
  ErrorMatrix P = covariance;
  advance_rows(P, x, dt);
  P.transposeInPlace();
  advance_rows(P, x, dt);
  P.transposeInPlace();
  const auto add = [&P, dt](int block, double variance) {
    P.diagonal().segment<3>(block).array() += dt * dt * variance;
  };
  add(E::kVelocity, noise.velocity);
  add(E::kAccelerometerBias, noise.accelerometer_bias);
  add(E::kGyroBias, noise.gyro_bias);
  add(E::kForce, noise.force);
  add(E::kRate, noise.rate);
  return P;
}

Belief updated(const Belief& prior, const Observation& observation) {
  return gain_update(prior, observation.innovation, observation.jacobian, observation.variance);
}

Belief updated(const Belief& prior, const PoseObservation& observation) {
  if (observation.innovation.size() == 1) return scalar_update(prior, observation);
  return gain_update(prior, observation.innovation, observation.jacobian, observation.variance);
}

bool is_usable(const Belief& belief) {
  const State& x = belief.state;
  return x.T_world_body.rotation.coeffs().allFinite() && x.velocity.allFinite() &&
         x.accelerometer_bias.allFinite() && x.gyro_bias.allFinite() && x.gravity.allFinite() &&
         x.force.allFinite() && x.rate.allFinite() && belief.covariance.allFinite() &&
         x.T_world_body.translation.norm() < kMaxDistance;
}

}  // namespace aims::leg_kilo
