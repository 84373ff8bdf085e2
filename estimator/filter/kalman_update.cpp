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

/// P - K H P - (K H P)^T + K S K^T: Joseph's form for any gain K. `PH` is P H^T and `KS` is K S,
/// with S = H P H^T + R.
template <int rows>
ErrorMatrix covariance_after(const ErrorMatrix& P, const Columns<rows>& PH,
                             const Columns<rows>& gain, const Columns<rows>& KS) {
  const Columns<rows> left = PH - 0.5 * KS;
  const ErrorMatrix half = gain.lazyProduct(left.transpose());
  return P - half - half.transpose();
}

/// The same with the gain M P H^T W, the mask M and W = S^-1.
template <int rows>
ErrorMatrix masked_covariance(const ErrorMatrix& P, const Columns<rows>& PH,
                              const Square<rows>& weight, const GainMask& mask) {
  const Columns<rows> masked = mask * PH;
  return covariance_after<rows>(P, PH, masked.lazyProduct(weight), masked);
}

/// The excess after a correction by the gain K of a measurement with the Jacobian H, without the
/// reset: (I - K H) E (I - K H)^T.
template <int rows>
ErrorMatrix excess_after(const ErrorMatrix& E, const Columns<rows>& gain,
                         const Eigen::Matrix<double, rows, ErrorState::kSize>& jacobian) {
  const ErrorMatrix kept = ErrorMatrix::Identity() - gain * jacobian;
  return kept * E * kept.transpose();
}

/// What a measurement that states less information leaves beyond the covariance `after`, without
/// the reset; `stated` is the covariance that the belief stated before.
ErrorMatrix excess_over(const ErrorMatrix& after, const ErrorMatrix& stated,
                        const PoseMeasurement& measurement, const GainMask& mask) {
  const Columns<6> PH = projected<6>(stated, measurement.jacobian);
  const Matrix6 S = measurement.jacobian.lazyProduct(PH);
  const Eigen::PartialPivLU<Matrix6> solver(Matrix6::Identity() + *measurement.stated * S);
  const Matrix6 weight = solver.solve(*measurement.stated);
  const Matrix6 symmetric = 0.5 * (weight + weight.transpose());
  return masked_covariance(stated, PH, symmetric, mask) - after;
}

}  // namespace

ErrorMatrix stated_covariance(const Belief& belief) {
  return belief.excess ? ErrorMatrix(belief.covariance + *belief.excess) : belief.covariance;
}

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
  Belief fused{boxplus(prior.state, delta),
               reset_covariance(masked_covariance(prior.covariance, PH, weight, mask), delta)};
  if (prior.excess) {
    const Columns<3> gain = mask * Columns<3>(PH.lazyProduct(weight));
    fused.excess =
        reset_covariance(excess_after<3>(*prior.excess, gain, measurement.jacobian), delta);
  }
  return fused;
}

Belief fuse_given_legs(const Belief& prior, const LinearMeasurement& measurement,
                       const GainMask& mask) {
  using E = ErrorState;
  const ErrorMatrix& P = prior.covariance;
  const Columns<3> PH = projected<3>(P, measurement.jacobian);
  const auto with_legs = P.middleCols<E::kLegSize>(E::kLegScale.offset);
  const Matrix6 legs = with_legs.middleRows<E::kLegSize>(E::kLegScale.offset);
  const Eigen::Matrix<double, E::kLegSize, 3> legs_PH =
      PH.middleRows<E::kLegSize>(E::kLegScale.offset);
  Columns<3> given = PH - with_legs * legs.ldlt().solve(legs_PH);
  given.middleRows<E::kLegSize>(E::kLegScale.offset).setZero();
  const Eigen::Matrix3d variance = measurement.jacobian.lazyProduct(given) + measurement.noise;
  const Columns<3> gain = mask * Columns<3>(given.lazyProduct(variance.inverse()));
  const Eigen::Matrix3d of_residual = measurement.jacobian.lazyProduct(PH) + measurement.noise;
  const ErrorVector delta = -gain * measurement.residual;
  const ErrorMatrix after = covariance_after<3>(P, PH, gain, gain.lazyProduct(of_residual));
  Belief fused{boxplus(prior.state, delta), reset_covariance(after, delta)};
  if (prior.excess) {
    fused.excess =
        reset_covariance(excess_after<3>(*prior.excess, gain, measurement.jacobian), delta);
  }
  return fused;
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
  const ErrorMatrix after = masked_covariance(P, PH, symmetric, mask);
  Belief fused{boxplus(linearization, delta), reset_covariance(after, delta)};
  if (measurement.stated) {
    const ErrorMatrix stated = reset_covariance(stated_covariance(prior), offset);
    fused.excess = reset_covariance(excess_over(after, stated, measurement, mask), delta);
  } else if (prior.excess) {
    const ErrorMatrix excess = reset_covariance(*prior.excess, offset);
    const Columns<6> gain = mask * Columns<6>(PH.lazyProduct(symmetric));
    fused.excess = reset_covariance(excess_after<6>(excess, gain, measurement.jacobian), delta);
  }
  return fused;
}

}  // namespace aims
