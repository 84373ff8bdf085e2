// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "bench/metrics/scores.hpp"
#include "bench/run/scenario.hpp"
#include "bench/run/sequence.hpp"
#include "bench/run/timed_estimator.hpp"
#include "core/error.hpp"
#include "estimator/estimator.hpp"

namespace aims {

/// What one estimator came to on one stream.
struct EstimatorOutcome {
  std::string name;
  EstimatorResult result;
  std::vector<Eigen::Vector3f> map;             ///< in its odometry frame [m]
  Scores scores;                                ///< of the online trajectory
  std::optional<Scores> optimized;              ///< of the re-optimized one
  std::vector<WeakAxisError> weak_axis_errors;  ///< along what the LiDAR cannot see, by scan
  std::vector<WeakAxisScore> weak_axis;         ///< summary of them
  ScanTimes scan_times;
  double wall_s = 0.0;
};

/// What an estimator that has finished came to, but for scores.
EstimatorOutcome outcome_of(const TimedEstimator& timed);

/// Scores an outcome against the truth of its sequence, the re-optimized trajectory by the same
/// rules as the online one. On an invalid run (bench/run/validity.hpp) neither is a success.
void add_scores(const Sequence& sequence, const Scenario& scenario, EstimatorOutcome& outcome);

/// Called with the part of the sequence that is done, in [0, 1].
using PartObserver = std::function<void(double)>;

/// Runs one estimator, with its settings on top of the scenario's, over the sequence and scores it,
/// on the calling thread. Error for a spec or a sequence that cannot be read.
Result<EstimatorOutcome> evaluate(const Sequence& sequence, const Scenario& scenario,
                                  const std::string& estimator, const PartObserver& observer);

}  // namespace aims
