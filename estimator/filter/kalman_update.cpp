// SPDX-License-Identifier: BSD-3-Clause
#include "estimator/filter/kalman_update.hpp"

#include <Eigen/Cholesky>
#include <Eigen/LU>

namespace aims {

template Belief kalman_update<NominalState>(const NominalState&, const ErrorMatrix&,
                                            const NominalState&, const Information&);
template Belief kalman_update<NominalState>(const NominalState&, const ErrorMatrix&,
                                            const NominalState&, const Information&,
                                            const ErrorMatrix&);

Belief fuse(const Belief& prior, const LinearMeasurement& measurement,
            const ErrorMatrix& gain_mask) {
  const Matrix3xError HP = measurement.jacobian * prior.covariance;
  const Eigen::Matrix3d S = HP * measurement.jacobian.transpose() + measurement.noise;
  const Matrix3xError gain_transposed = S.llt().solve(HP) * gain_mask.transpose();
  // With the gain K = M P H^T S^-1 for any mask M: P - K H P - (K H P)^T + K S K^T.
  const ErrorVector delta = -gain_transposed.transpose() * measurement.residual;
  const ErrorMatrix KHP = gain_transposed.transpose() * HP;
  const ErrorMatrix covariance =
      prior.covariance - KHP - KHP.transpose() + gain_transposed.transpose() * S * gain_transposed;
  const ErrorMatrix G = reset_jacobian(prior.state, delta);
  return {boxplus(prior.state, delta),
          G * (0.5 * (covariance + covariance.transpose())) * G.transpose()};
}

Information information_of(const LinearMeasurement& measurement) {
  const Matrix3xError weighted = measurement.noise.inverse() * measurement.jacobian;
  return {measurement.jacobian.transpose() * weighted, weighted.transpose() * measurement.residual};
}

Information pose_information(const Matrix6& matrix, const Vector6& vector) {
  Information information;
  pose_block(information.matrix) = matrix;
  pose_segment(information.vector) = vector;
  return information;
}

ErrorMatrix consider_legs(ErrorMatrix gain_mask) {
  gain_mask.middleRows<ErrorState::kLegSize>(ErrorState::kLegScale.offset).setZero();
  return gain_mask;
}

ErrorMatrix limit_motion(ErrorMatrix gain_mask, const Eigen::Matrix3d& factor) {
  block(gain_mask, ErrorState::kPosition, ErrorState::kPosition) = factor;
  block(gain_mask, ErrorState::kVelocity, ErrorState::kVelocity) = factor;
  return gain_mask;
}

}  // namespace aims
