// SPDX-License-Identifier: BSD-3-Clause
#include "estimator/baselines/fast_lio2/iterated_update.hpp"

#include <Eigen/LU>

namespace aims::fast_lio2 {
namespace {

/// Quantities of one iteration.
struct Step {
  ErrorMatrix prior;  ///< covariance of the prior at the present state
  ErrorMatrix KH;     ///< K H
  ErrorVector error;  ///< of the state after the step
};

/// The step from `x` for the residuals there.
Step step_from(const State& x, const Belief& prior, const ScanResiduals& residuals,
               double variance) {
  const ErrorVector moved = minus(x, prior.state);
  const Transport transport(prior.state, x, moved);
  Step step;
  step.prior = transport.of_covariance(prior.covariance);
  const Eigen::Matrix<double, Error::kMeasured, Error::kMeasured> HtH =
      residuals.jacobian.transpose() * residuals.jacobian;
  ErrorMatrix information = (step.prior / variance).inverse();
  information.topLeftCorner<Error::kMeasured, Error::kMeasured>() += HtH;
  const Eigen::Matrix<double, Error::kSize, Error::kMeasured> gain =
      information.inverse().leftCols<Error::kMeasured>();  // K = gain H^T
  step.KH.setZero();
  step.KH.leftCols<Error::kMeasured>() = gain * HtH;
  const ErrorVector pulled = transport * moved;
  step.error =
      -(gain * (residuals.jacobian.transpose() * residuals.distances)) + step.KH * pulled - pulled;
  return step;
}

/// The covariance after the last step, in the tangential space of the state that it led to.
ErrorMatrix covariance_after(const Step& step, const State& before, const State& after) {
  const Transport transport(before, after, step.error);
  const ErrorMatrix prior = transport.of_covariance(step.prior);
  return prior - (transport * step.KH) * transport.on_columns(step.prior);
}

}  // namespace

Update iterated_update(const Belief& prior, const ResidualsAt& residuals, double variance,
                       const Iterations& config) {
  Update update;
  update.belief = prior;
  bool search = true;
  int small_steps = 0;
  for (int i = 0; i <= config.max; ++i) {
    const State before = update.belief.state;
    const ScanResiduals& now = residuals(before, search);
    if (now.distances.size() == 0) continue;
    const Step step = step_from(before, prior, now, variance);
    update.belief.state = plus(before, step.error);
    ++update.iterations;
    update.converged = (step.error.array().abs() <= config.convergence).all();
    small_steps += update.converged ? 1 : 0;
    search = update.converged || (small_steps == 0 && i == config.max - 1);
    if (small_steps > 1 || i == config.max) {
      update.residuals = now;
      update.belief.covariance = covariance_after(step, before, update.belief.state);
      break;
    }
  }
  return update;
}

}  // namespace aims::fast_lio2
