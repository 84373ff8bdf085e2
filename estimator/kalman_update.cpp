// SPDX-License-Identifier: BSD-3-Clause
#include "estimator/kalman_update.hpp"

#include <Eigen/Cholesky>
#include <Eigen/LU>

namespace aims {
namespace {

/// Covariance of the update whose gain is zero in all entries beyond the first `learned`, from the
/// covariance of the full update (Joseph's form in information: K H = C A, K R K^T = C A C).
ErrorMatrix considered(const ErrorMatrix& full, const ErrorMatrix& prior_information,
                       const ErrorMatrix& measured, int learned) {
  ErrorMatrix gain = full * measured;
  gain.bottomRows(ErrorState::kSize - learned).setZero();
  const ErrorMatrix kept = ErrorMatrix::Identity() - gain;
  ErrorMatrix masked = full;
  masked.bottomRows(ErrorState::kSize - learned).setZero();
  const ErrorMatrix covariance = kept * inverse_spd(prior_information) * kept.transpose() +
                                 masked * measured * masked.transpose();
  return 0.5 * (covariance + covariance.transpose());
}

}  // namespace

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
                     const NominalState& linearization, const Information& measurements,
                     int learned) {
  const ErrorVector offset = boxminus(linearization, prior);
  const ErrorMatrix J = boxminus_jacobian(offset);
  const ErrorMatrix weighted = J.transpose() * prior_information;
  const ErrorMatrix information = weighted * J;
  ErrorMatrix covariance = inverse_spd(information + measurements.matrix);
  ErrorVector delta = -covariance * (weighted * offset + measurements.vector);
  if (learned < ErrorState::kSize) {
    delta.tail(ErrorState::kSize - learned).setZero();
    covariance = considered(covariance, information, measurements.matrix, learned);
  }
  const ErrorMatrix G = reset_jacobian(delta);
  return {boxplus(linearization, delta), G * covariance * G.transpose()};
}

}  // namespace aims
