// SPDX-License-Identifier: BSD-3-Clause
#include "estimator/kalman_update.hpp"

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

Matrix15 inverse_spd(const Matrix15& matrix) {
  const Matrix15 inverse = matrix.llt().solve(Matrix15::Identity());
  return 0.5 * (inverse + inverse.transpose());
}

Belief kalman_update(const NominalState& prior, const Matrix15& prior_information,
                     const NominalState& linearization, const Information& measurements) {
  const Vector15 offset = boxminus(linearization, prior);
  const Matrix15 J = boxminus_jacobian(offset);
  const Matrix15 weighted = J.transpose() * prior_information;
  const Matrix15 posterior_information = weighted * J + measurements.matrix;
  const Matrix15 covariance = inverse_spd(posterior_information);
  const Vector15 delta = -covariance * (weighted * offset + measurements.vector);
  const Matrix15 G = reset_jacobian(delta);
  return {boxplus(linearization, delta), G * covariance * G.transpose()};
}

}  // namespace aims
