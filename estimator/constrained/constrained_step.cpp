// SPDX-License-Identifier: BSD-3-Clause
#include "estimator/constrained/constrained_step.hpp"

#include <Eigen/Cholesky>
#include <Eigen/LU>

namespace aims {
namespace {

using Rows = Eigen::Matrix<double, Eigen::Dynamic, 1, Eigen::ColMajor, 6, 1>;
using Directions = Eigen::Matrix<double, 6, Eigen::Dynamic, Eigen::ColMajor, 6, 6>;

/// Moves `correction` onto the constraints `which`, by the shortest way in the metric of the
/// covariance `P`, and takes the part of `gain` along them.
void project(const std::vector<PoseConstraint>& which, const ErrorMatrix& P,
             ErrorVector& correction, LinearScan::Gain& gain) {
  if (which.empty()) return;
  const auto count = static_cast<Eigen::Index>(which.size());
  Directions C(6, count);
  Rows values(count);
  for (Eigen::Index i = 0; i < count; ++i) {
    C.col(i) = which[static_cast<std::size_t>(i)].direction;
    values(i) = which[static_cast<std::size_t>(i)].value;
  }
  const Eigen::MatrixXd PC = P.leftCols<ErrorState::kPoseSize>() * C;
  const Eigen::LDLT<Eigen::MatrixXd> multipliers(C.transpose() *
                                                 PC.topRows<ErrorState::kPoseSize>());
  const Rows missing = values - C.transpose() * pose_segment(correction);
  correction += PC * multipliers.solve(missing);
  Directions free = C;
  for (Eigen::Index i = 0; i < count; ++i) {
    if (which[static_cast<std::size_t>(i)].measured) free.col(i).setZero();
  }
  const Eigen::MatrixXd along = free.transpose() * gain.topRows<ErrorState::kPoseSize>();
  gain -= PC * multipliers.solve(along);
}

}  // namespace

LinearScan::LinearScan(const Belief& prior, const NominalState& linearization,
                       const PoseMeasurement& scan)
    : at(linearization),
      offset(boxminus(linearization, prior.state)),
      P(reset_covariance(prior.covariance, offset)),
      PH(P * scan.jacobian.transpose()),
      S(scan.jacobian * PH),
      A(scan.matrix),
      innovation(scan.vector - scan.matrix * (scan.jacobian * offset)) {}

Belief LinearScan::corrected(const ErrorVector& correction, const Gain& gain,
                             const GainMask& mask) const {
  const ErrorVector delta = mask * correction - offset;
  const Gain masked = mask * gain;
  const Gain KA = masked * A;
  const ErrorMatrix half =
      KA * PH.transpose() - 0.5 * (KA * (S * A + Matrix6::Identity()) * masked.transpose());
  return {boxplus(at, delta), reset_covariance(P - half - half.transpose(), delta)};
}

Belief constrained_step(const Belief& prior, const NominalState& linearization,
                        const Linearization& scan, const PoseConstraints& constraints) {
  const LinearScan linear(prior, linearization, scan.measurement);
  const Matrix6 information = linear.A + constraints.damping;
  const Matrix6 inverse = (Matrix6::Identity() + information * linear.S).inverse();
  LinearScan::Gain gain = linear.PH * inverse;
  ErrorVector correction = -gain * linear.innovation;
  const ErrorMatrix posterior = linear.P - gain * information * linear.PH.transpose();
  project(constraints.equal, posterior, correction, gain);
  return linear.corrected(correction, gain, scan.mask);
}

}  // namespace aims
