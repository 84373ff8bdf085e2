// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

#include "bench/metrics/localizability_scores.hpp"
#include "bench/metrics/scores.hpp"
#include "bench/scoring/timed_estimator.hpp"
#include "estimator/interface/estimator.hpp"

namespace aims {

/// What one estimator came to on one stream.
struct EstimatorOutcome {
  std::string name;
  EstimatorResult result;
  std::vector<LearnedQuantity> learned;         ///< of the robot
  std::vector<Eigen::Vector3f> map;             ///< in its odometry frame [m]
  Scores scores;                                ///< of the online trajectory
  std::optional<Scores> optimized;              ///< of the re-optimized one
  std::vector<WeakAxisError> weak_axis_errors;  ///< along what the LiDAR cannot see, by scan
  std::vector<WeakAxisScore> weak_axis;         ///< summary of them
  ScanTimes scan_times;
  double wall_s = 0.0;
  EstimatorTotals totals;  ///< of an estimate of a recording
};

/// The trajectory with the poses that are left out of it since they were not finite or not rigid,
/// as poses that are not finite: a score counts them, and such an estimate is no success.
Trajectory with_invalid_poses(Trajectory trajectory, const EstimatorResult& result);

/// What an estimator that has finished came to, but for scores and totals.
EstimatorOutcome outcome_of(const TimedEstimator& timed);

/// The same but for the rows of its result: trajectory, scans and health.
EstimatorOutcome outcome_without_rows(const TimedEstimator& timed);

/// All rows of an outcome that has them.
EstimatorRows rows_of(const EstimatorOutcome& outcome);

}  // namespace aims
