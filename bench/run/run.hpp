// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "bench/metrics/scores.hpp"
#include "bench/run/run_legs.hpp"
#include "bench/run/run_localizability.hpp"
#include "bench/run/scenario.hpp"
#include "bench/run/timed_estimator.hpp"
#include "core/error.hpp"
#include "estimator/estimator.hpp"
#include "sim/environment/scene.hpp"
#include "sim/robot/truth.hpp"
#include "sim/simulation.hpp"

namespace aims {

struct RunOptions {
  std::uint64_t seed = 1;
  int jobs = 1;  ///< threads; the results do not depend on it
};

/// How far a run has come.
struct Progress {
  double simulated_s = 0.0;
  double expected_s = 0.0;
  double wall_s = 0.0;
};

/// Called between batches; returning false ends the run early with what there is.
using Observer = std::function<bool(const Progress&)>;

/// One estimator's part of a run.
struct EstimatorOutcome {
  std::string name;
  EstimatorResult result;
  std::vector<Eigen::Vector3f> map;  ///< in its odometry frame [m]
  Scores scores;
  std::vector<WeakAxisError> weak_axis_errors;  ///< along what the LiDAR cannot see, by scan
  std::vector<WeakAxisScore> weak_axis;         ///< summary of them
  std::vector<double> scan_times_ms;
  double wall_s = 0.0;
};

/// Everything that one run yields, before it is written.
struct RunResult {
  std::uint64_t seed = 0;
  bool complete = false;  ///< false when the observer ended it early
  double simulated_s = 0.0;
  double wall_s = 0.0;
  SimulationTimes simulation_times;
  Scene scene;
  Truth truth;
  Trajectory truth_trajectory;       ///< T_world_body at the physics rate
  RunLocalizability localizability;  ///< what the scans allow to know
  std::vector<LegInterval> legs;     ///< what became of the leg odometry, from the start
  std::vector<EstimatorOutcome> estimators;
};

/// What an estimator that has finished came to, by the truth and localizability of `result`.
EstimatorOutcome outcome_of(const TimedEstimator& timed, const RunResult& result,
                            const Scenario& scenario);

/// Simulates the scenario, feeds every estimator the same stream, and scores each against truth.
/// Error when the scenario cannot be simulated (robot in a wall, no path).
Result<RunResult> run(const Scenario& scenario, const RunOptions& options,
                      const Observer& observer);

}  // namespace aims
