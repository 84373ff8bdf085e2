// SPDX-License-Identifier: BSD-3-Clause
#include "estimator/filter/kalman_update.hpp"

#include <Eigen/Cholesky>
#include <Eigen/LU>

namespace aims {
namespace {

template <int rows>
using Columns = Eigen::Matrix<double, ErrorState::kSize, rows>;
template <int rows>
using Square = Eigen::Matrix<double, rows, rows>;

/// P H^T.
template <int rows>
Columns<rows> projected(const ErrorMatrix& P,
                        const Eigen::Matrix<double, rows, ErrorState::kSize>& jacobian) {
  return P.lazyProduct(jacobian.transpose());
}

/// P - K H P - (K H P)^T + K (H P H^T + R) K^T with the gain K = M P H^T W, the mask M and
/// W = (H P H^T + R)^-1: Joseph's form for any mask. `PH` is P H^T.
template <int rows>
ErrorMatrix masked_covariance(const ErrorMatrix& P, const Columns<rows>& PH,
                              const Square<rows>& weight, const GainMask& mask) {
  const Columns<rows> masked = mask * PH;
  const Columns<rows> gain = masked.lazyProduct(weight);
  const Columns<rows> left = PH - 0.5 * masked;
  const ErrorMatrix half = gain.lazyProduct(left.transpose());
  return P - half - half.transpose();
}

}  // namespace

LinearMeasurement moved_to(const LinearMeasurement& measurement, const NominalState& from,
                           const NominalState& to) {
  LinearMeasurement there = measurement;
  there.residual += measurement.jacobian * boxminus(to, from);
  return there;
}

ErrorMatrix GainMask::matrix() const { return *this * ErrorMatrix(ErrorMatrix::Identity()); }

Belief fuse(const Belief& prior, const LinearMeasurement& measurement, const GainMask& mask) {
  const Columns<3> PH = projected<3>(prior.covariance, measurement.jacobian);
  const Eigen::Matrix3d weight =
      (measurement.jacobian.lazyProduct(PH) + measurement.noise).inverse();
  const ErrorVector delta = mask * ErrorVector(-PH * (weight * measurement.residual));
  return {boxplus(prior.state, delta),
          reset_covariance(masked_covariance(prior.covariance, PH, weight, mask), delta)};
}

Belief fuse(const Belief& prior, const NominalState& linearization,
            const PoseMeasurement& measurement, const GainMask& mask) {
  const ErrorVector offset = boxminus(linearization, prior.state);
  // About the linearization, the prior has the mean -offset: rotations about themselves stay.
  const ErrorMatrix P = reset_covariance(prior.covariance, offset);
  const Columns<6> PH = projected<6>(P, measurement.jacobian);
  // (H P H^T + A^-1)^-1 for an information A that may be singular.
  const Matrix6 S = measurement.jacobian.lazyProduct(PH);
  const Eigen::PartialPivLU<Matrix6> solver(Matrix6::Identity() + measurement.matrix * S);
  const Matrix6 weight = solver.solve(measurement.matrix);
  const Vector6 innovation =
      measurement.vector - measurement.matrix * (measurement.jacobian * offset);
  const ErrorVector correction = mask * ErrorVector(-PH * solver.solve(innovation));
  const ErrorVector delta = correction - offset;
  const Matrix6 symmetric = 0.5 * (weight + weight.transpose());
  return {boxplus(linearization, delta),
          reset_covariance(masked_covariance(P, PH, symmetric, mask), delta)};
}

}  // namespace aims
