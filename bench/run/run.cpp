// SPDX-License-Identifier: BSD-3-Clause
#include "bench/run/run.hpp"

#include "bench/run/stream.hpp"
#include "core/stopwatch.hpp"

namespace aims {

EstimatorOutcome outcome_of(const TimedEstimator& timed, const RunResult& result,
                            const Scenario& scenario) {
  const ScoreConfig& scoring = scenario.scoring;
  EstimatorOutcome outcome;
  outcome.name = timed.name();
  outcome.result = timed.estimator().result();
  outcome.map = timed.estimator().map_points();
  outcome.scores = score(outcome.result.trajectory, result.truth_trajectory,
                         result.truth.waypoint_times, scoring);
  outcome.weak_axis_errors =
      weak_axis_errors_of(outcome.result, result.truth_trajectory, result.localizability, scoring,
                          half_scan(scenario.simulation));
  outcome.weak_axis = weak_axis_scores(outcome.weak_axis_errors);
  outcome.scan_times_ms = timed.scan_times_ms();
  outcome.wall_s = timed.total_seconds();
  return outcome;
}

Result<RunResult> run(const Scenario& scenario, const RunOptions& options,
                      const Observer& observer) {
  const Stopwatch stopwatch;
  auto simulation = Simulation::create(scenario.simulation, options.seed);
  if (!simulation) return tl::unexpected(located(scenario, simulation.error()));
  auto estimators = make_estimators(scenario.estimators, scenario.estimator, simulation->rig());
  if (!estimators) return tl::unexpected(estimators.error());

  const double expected_s = to_seconds(simulation->expected_duration());
  LegPackets leg_packets;
  const auto next_batch = [&](std::vector<Delivery>& batch) {
    const bool more = simulation->advance(kStreamBatch, batch);
    leg_packets.count(batch);
    return more;
  };
  const StreamEnd end = stream(next_batch, *estimators, options.jobs, [&] {
    return observer({to_seconds(simulation->now()), expected_s, stopwatch.seconds()});
  });
  RunResult result;
  result.seed = options.seed;
  result.complete = !end.stopped;
  result.simulated_s = to_seconds(simulation->now());
  result.simulation_times = simulation->times();
  result.scene = simulation->scene();
  result.truth = simulation->truth();
  result.truth_trajectory = body_trajectory(result.truth);
  result.localizability = run_localizability(scenario.simulation, simulation->rig(), result.truth,
                                             result.truth_trajectory);
  result.legs = leg_intervals(scenario.simulation, leg_packets, result.truth, simulation->now());
  for (const TimedEstimator& each : *estimators) {
    result.estimators.push_back(outcome_of(each, result, scenario));
  }
  result.wall_s = stopwatch.seconds();
  return result;
}

}  // namespace aims
