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
                     const ErrorMatrix& mask) {
  const ErrorVector offset = boxminus(linearization, prior);
  const ErrorMatrix J = boxminus_jacobian(offset);
  const ErrorMatrix weighted = J.transpose() * prior_information;
  const ErrorMatrix information = weighted * J;
  const ErrorMatrix full = inverse_spd(information + measurements.matrix);
  const ErrorVector step = -full * (weighted * offset + measurements.vector);
  // The mask acts on the whole way from the prior, of which `offset` is already gone.
  const ErrorVector delta = mask * (offset + step) - offset;
  // Joseph's form with K H = C A and K R K^T = C A C.
  const ErrorMatrix gain = mask * full;
  const ErrorMatrix kept = ErrorMatrix::Identity() - gain * measurements.matrix;
  const ErrorMatrix covariance = kept * inverse_spd(information) * kept.transpose() +
                                 gain * measurements.matrix * gain.transpose();
  const ErrorMatrix G = reset_jacobian(delta);
  return {boxplus(linearization, delta),
          G * (0.5 * (covariance + covariance.transpose())) * G.transpose()};
}

ErrorMatrix hold_legs(ErrorMatrix mask) {
  mask.bottomRows<ErrorState::kSize - ErrorState::kMotionSize>().setZero();
  return mask;
}

ErrorMatrix hold_position(ErrorMatrix mask) {
  mask.middleRows<3>(ErrorState::kPosition.offset).setZero();
  return mask;
}

ErrorMatrix hold_motion(ErrorMatrix mask, const Eigen::Matrix3d& kept) {
  block(mask, ErrorState::kPosition, ErrorState::kPosition) = kept;
  block(mask, ErrorState::kVelocity, ErrorState::kVelocity) = kept;
  return mask;
}

}  // namespace aims
