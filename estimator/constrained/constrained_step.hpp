// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <vector>

#include "estimator/filter/kalman_update.hpp"

namespace aims {

/// An equality that the pose after an update obeys.
struct PoseConstraint {
  Vector6 direction = Vector6::Zero();  ///< unit: of the rotation (body axes) or of the position
  double value = 0.0;                   ///< of the pose relative to the prior along it [rad or m]
  bool measured = false;  ///< by the scan; otherwise the scan has no information along it
};

/// What an update with a scan obeys beside the least squares of prior and scan.
struct PoseConstraints {
  std::vector<PoseConstraint> equal;
  /// Information by which the pose is pulled towards the prior on top of the prior's own.
  Matrix6 damping = Matrix6::Zero();
};

/// An update with a scan, linearized: the prior about the linearization and the scan's innovation.
struct LinearScan {
  using Gain = Eigen::Matrix<double, ErrorState::kSize, 6>;

  /// `scan` is linearized at `linearization`.
  LinearScan(const Belief& prior, const NominalState& linearization, const PoseMeasurement& scan);

  /// The belief after moving the prior by `correction`, of which the scan's innovation has the gain
  /// -`gain`, both only in the states that `mask` lets a scan correct; the covariance is Joseph's.
  Belief corrected(const ErrorVector& correction, const Gain& gain, const GainMask& mask) const;

  NominalState at;     ///< linearization
  ErrorVector offset;  ///< of it from the prior
  ErrorMatrix P;       ///< prior covariance about it
  Gain PH;             ///< P H^T
  Matrix6 S;           ///< H P H^T
  Matrix6 A;           ///< information of the scan
  Vector6 innovation;  ///< H^T R^-1 r at the prior
};

/// The least squares of prior and scan under `constraints`, by Lagrange multipliers: minimizes
/// x^T P^-1 x / 2 + (r + H x)^T R^-1 (r + H x) / 2 + x^T D x / 2 with C x = c, for the error x
/// relative to the prior and the damping D. The stated covariance is that of the resulting gain; a
/// constraint without information leaves the prior's variance along it. (X-ICP, Tuna et al. 2023,
/// has no prior but the start of the iteration; docs/baselines/constrained.md.)
Belief constrained_step(const Belief& prior, const NominalState& linearization,
                        const Linearization& scan, const PoseConstraints& constraints);

}  // namespace aims
