// SPDX-License-Identifier: BSD-3-Clause
#include "bench/scoring/outcome.hpp"

#include <algorithm>
#include <limits>

namespace aims {

Trajectory with_invalid_poses(Trajectory trajectory, const EstimatorResult& result) {
  StampedPose invalid;
  invalid.pose.translation.setConstant(std::numeric_limits<double>::quiet_NaN());
  for (const Time stamp : result.invalid_poses) {
    invalid.stamp = stamp;
    trajectory.push_back(invalid);
  }
  std::ranges::stable_sort(trajectory, {}, &StampedPose::stamp);
  return trajectory;
}

EstimatorOutcome outcome_of(const TimedEstimator& timed) {
  const EstimatorResult& result = timed.estimator().result();
  EstimatorOutcome outcome = outcome_without_rows(timed);
  outcome.result.trajectory = result.trajectory;
  outcome.result.diagnostics.scans = result.diagnostics.scans;
  outcome.result.health = result.health;
  return outcome;
}

EstimatorOutcome outcome_without_rows(const TimedEstimator& timed) {
  const EstimatorResult& result = timed.estimator().result();
  EstimatorOutcome outcome;
  outcome.name = timed.name();
  outcome.result.optimized = result.optimized;
  outcome.result.diagnostics.series = result.diagnostics.series;
  outcome.result.invalid_poses = result.invalid_poses;
  outcome.result.counts = result.counts;
  outcome.result.failure = result.failure;
  outcome.result.external_cpu_s = result.external_cpu_s;
  outcome.learned = timed.estimator().learned();
  outcome.map = timed.estimator().map_points();
  outcome.scan_times = timed.scan_times();
  outcome.wall_s = timed.total_seconds();
  return outcome;
}

EstimatorRows rows_of(const EstimatorOutcome& outcome) {
  const EstimatorResult& result = outcome.result;
  return {.poses = result.trajectory,
          .series = result.diagnostics.series,
          .scans = result.diagnostics.scans,
          .wall_ms = outcome.scan_times.wall_ms,
          .health = result.health};
}

}  // namespace aims
