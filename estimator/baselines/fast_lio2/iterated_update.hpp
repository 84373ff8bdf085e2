// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>

#include "estimator/baselines/fast_lio2/prediction.hpp"
#include "estimator/baselines/fast_lio2/registration.hpp"

namespace aims::fast_lio2 {

/// The result of an iterated update.
struct Update {
  Belief belief;
  int iterations = 0;            ///< with residuals; 0: no update
  bool converged = false;        ///< the last step was within the limit
  ScanResiduals residuals = {};  ///< of the last iteration, before its step
};

/// Residuals at a state; `search`: associate again.
using ResidualsAt = std::function<const ScanResiduals&(const State&, bool search)>;

/// The iterated Kalman update on the manifold (FAST-LIO2, eqs. 18-20). Each iteration moves the
/// prior's covariance to the tangential space of the present state and steps by
///   K z - (I - K H) J (x [-] x_prior),  K = (H^T H + (P / R)^-1)^-1 H^T.
/// Points are associated again only after a step within the limit, as in the published program, and
/// before the last iteration. The covariance follows from the last iteration.
Update iterated_update(const Belief& prior, const ResidualsAt& residuals, double variance,
                       const Iterations& config);

}  // namespace aims::fast_lio2
