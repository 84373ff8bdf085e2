// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "estimator/baselines/features/feature_matches.hpp"

namespace aims::features {

/// Sum of Huber's loss over the distances of matched points from their lines and planes.
class HuberProblem {
 public:
  /// The loss of a distance is quadratic up to `delta` [m], then linear.
  HuberProblem(const FeatureMatches& matches, double delta) : matches_(matches), delta_(delta) {}

  /// The problem around a pose, with the weight of each residual fixed.
  struct Linearized {
    double cost = 0.0;                      ///< half the sum of the losses [m^2]
    Matrix6 information = Matrix6::Zero();  ///< J^T J, rotation then position
    Vector6 gradient = Vector6::Zero();     ///< J^T r
  };

  double cost(const Pose& pose) const;
  Linearized linearized(const Pose& pose) const;

 private:
  const FeatureMatches& matches_;
  double delta_;
};

struct Minimum {
  Pose pose;
  int iterations = 0;
};

/// Levenberg and Marquardt's method with the trust region rule, the scaling of columns and the
/// tolerances that the Ceres solver has by default, at most `max_iterations`.
Minimum minimize(const HuberProblem& problem, const Pose& initial, int max_iterations);

}  // namespace aims::features
