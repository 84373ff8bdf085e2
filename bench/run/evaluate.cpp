// SPDX-License-Identifier: BSD-3-Clause
#include "bench/run/evaluate.hpp"

#include "bench/estimate/stream.hpp"
#include "bench/run/estimator_fit.hpp"
#include "bench/scoring/health_time.hpp"
#include "bench/scoring/validity.hpp"

namespace aims {
namespace {

/// Hands every measurement to the estimator, in order of arrival.
Result<void> stream_into(const Sequence& sequence, TimedEstimator& estimator,
                         const PartObserver& observer) {
  const double end_s = to_seconds(sequence.end());
  Time next = 0;
  const auto replayed = sequence.reader.replay([&](const Delivery& delivery) {
    estimator.consume({&delivery, 1});
    if (delivery.arrival < next) return;
    observer(to_seconds(delivery.arrival) / end_s);
    next = delivery.arrival + kStreamBatch;
  });
  estimator.finish();
  return replayed;
}

}  // namespace

void add_scores(const Sequence& sequence, const Scenario& scenario, EstimatorOutcome& outcome) {
  const auto scores_of = [&](const Trajectory& trajectory) {
    return score(trajectory, sequence.truth_trajectory, sequence.waypoint_times, scenario.scoring);
  };
  const EstimatorResult& result = outcome.result;
  outcome.scores = scores_of(with_invalid_poses(result.trajectory, result));
  if (result.optimized) outcome.optimized = scores_of(*result.optimized);
  if (invalid_reason(sequence.walk, to_seconds(sequence.end()))) {
    withdraw_success(outcome.scores, FailureReason::kInvalidRun);
    if (outcome.optimized) withdraw_success(*outcome.optimized, FailureReason::kInvalidRun);
  }
  outcome.weak_axis_errors =
      weak_axis_errors_of(result, sequence.truth_trajectory, sequence.localizability,
                          scenario.scoring, half_scan(scenario.simulation));
  outcome.weak_axis = weak_axis_scores(outcome.weak_axis_errors);
}

Result<EstimatorOutcome> evaluate(const Sequence& sequence, const Scenario& scenario,
                                  const std::string& estimator, const PartObserver& observer) {
  auto estimators = make_estimators({&estimator, 1}, scenario.estimators, sequence.reader.rig());
  if (!estimators) return tl::unexpected(estimators.error());
  auto streamed = stream_into(sequence, estimators->front(), observer);
  if (!streamed) return tl::unexpected(streamed.error());
  EstimatorOutcome outcome = outcome_of(estimators->front());
  if (outcome.result.failure) return tl::unexpected(*outcome.result.failure);
  if (is_of_another_robot(estimator, scenario)) {
    outcome.result.health = warned(outcome.result.health, {kOtherRobot});
  }
  add_scores(sequence, scenario, outcome);
  return outcome;
}

}  // namespace aims
