// SPDX-License-Identifier: BSD-3-Clause
#include "estimator/filter/kalman_update.hpp"

#include <Eigen/Cholesky>
#include <Eigen/LU>

namespace aims {

Information information_of(const LinearMeasurement& measurement) {
  const Eigen::Matrix<double, 3, ErrorState::kSize> weighted =
      measurement.noise.inverse() * measurement.jacobian;
  return {measurement.jacobian.transpose() * weighted, weighted.transpose() * measurement.residual};
}

Information pose_information(const Matrix6& matrix, const Vector6& vector) {
  Information information;
  pose_block(information.matrix) = matrix;
  pose_segment(information.vector) = vector;
  return information;
}

ErrorMatrix inverse_spd(const ErrorMatrix& matrix) {
  const ErrorMatrix inverse = matrix.llt().solve(ErrorMatrix::Identity());
  return 0.5 * (inverse + inverse.transpose());
}

Belief kalman_update(const NominalState& prior, const ErrorMatrix& prior_information,
                     const NominalState& linearization, const Information& measurements) {
  const ErrorVector offset = boxminus(linearization, prior);
  const ErrorMatrix J = boxminus_jacobian(offset);
  const ErrorMatrix weighted = J.transpose() * prior_information;
  const ErrorMatrix posterior_information = weighted * J + measurements.matrix;
  const ErrorMatrix covariance = inverse_spd(posterior_information);
  const ErrorVector delta = -covariance * (weighted * offset + measurements.vector);
  const ErrorMatrix G = reset_jacobian(delta);
  return {boxplus(linearization, delta), G * covariance * G.transpose()};
}

Belief kalman_update(const NominalState& prior, const ErrorMatrix& prior_information,
                     const NominalState& linearization, const Information& measurements,
                     const ErrorMatrix& gain_mask) {
  const ErrorVector offset = boxminus(linearization, prior);
  const ErrorMatrix J = boxminus_jacobian(offset);
  const ErrorMatrix weighted = J.transpose() * prior_information;
  const ErrorMatrix information = weighted * J;
  const ErrorMatrix full = inverse_spd(information + measurements.matrix);
  const ErrorVector step = -full * (weighted * offset + measurements.vector);
  // The mask applies to the total correction from the prior; `offset` of it is already applied.
  const ErrorVector delta = gain_mask * (offset + step) - offset;
  // Joseph's form with K H = C A and K R K^T = C A C^T, C = gain.
  const ErrorMatrix gain = gain_mask * full;
  const ErrorMatrix kept = ErrorMatrix::Identity() - gain * measurements.matrix;
  const ErrorMatrix covariance = kept * inverse_spd(information) * kept.transpose() +
                                 gain * measurements.matrix * gain.transpose();
  const ErrorMatrix G = reset_jacobian(delta);
  return {boxplus(linearization, delta),
          G * (0.5 * (covariance + covariance.transpose())) * G.transpose()};
}

ErrorMatrix consider_legs(ErrorMatrix gain_mask) {
  gain_mask.bottomRows<ErrorState::kSize - ErrorState::kMotionSize>().setZero();
  return gain_mask;
}

ErrorMatrix consider_position(ErrorMatrix gain_mask) {
  gain_mask.middleRows<3>(ErrorState::kPosition.offset).setZero();
  return gain_mask;
}

ErrorMatrix limit_motion(ErrorMatrix gain_mask, const Eigen::Matrix3d& factor) {
  block(gain_mask, ErrorState::kPosition, ErrorState::kPosition) = factor;
  block(gain_mask, ErrorState::kVelocity, ErrorState::kVelocity) = factor;
  return gain_mask;
}

}  // namespace aims
