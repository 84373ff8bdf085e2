// SPDX-License-Identifier: BSD-3-Clause
#include "harness/run.hpp"

#include <tbb/task_arena.h>
#include <tbb/task_group.h>

#include <chrono>
#include <utility>

#include "estimator/registry.hpp"
#include "harness/timed_estimator.hpp"

namespace aims {
namespace {

/// Stream handed over between simulation and estimators at a time: bounds the memory of a run.
constexpr Duration kBatch = kSecond;

class Stopwatch {
 public:
  double seconds() const {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
  }

 private:
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

Result<std::vector<TimedEstimator>> make_estimators(const Scenario& scenario,
                                                    const SensorRig& rig) {
  std::vector<TimedEstimator> estimators;
  for (const std::string& name : scenario.estimators) {
    auto made = make_estimator(name, scenario.estimator, rig);
    if (!made) return tl::unexpected(made.error());
    estimators.emplace_back(name, std::move(*made));
  }
  return estimators;
}

/// Streams the whole run: while the estimators work on one batch, the next is simulated.
/// True when the simulation came to its own end.
bool stream(Simulation& simulation, std::vector<TimedEstimator>& estimators, int jobs,
            const Observer& observer) {
  const Stopwatch stopwatch;
  const double expected_s = to_seconds(simulation.expected_duration());
  tbb::task_arena arena(jobs);
  std::vector<Delivery> current;
  std::vector<Delivery> next;
  bool walking = simulation.advance(kBatch, current);
  bool wanted = true;
  for (bool pending = true; pending && wanted;) {
    pending = walking;
    next.clear();
    arena.execute([&] {
      tbb::task_group tasks;
      for (TimedEstimator& each : estimators) tasks.run([&] { each.consume(current); });
      if (walking) tasks.run([&] { walking = simulation.advance(kBatch, next); });
      tasks.wait();
    });
    std::swap(current, next);
    wanted = observer({to_seconds(simulation.now()), expected_s, stopwatch.seconds()});
  }
  arena.execute([&] {
    tbb::task_group tasks;
    for (TimedEstimator& each : estimators) tasks.run([&each] { each.finish(); });
    tasks.wait();
  });
  return wanted;
}

EstimatorOutcome outcome_of(const TimedEstimator& timed, const RunResult& result,
                            const Scenario& scenario) {
  const ScoreConfig& scoring = scenario.scoring;
  EstimatorOutcome outcome;
  outcome.name = timed.name();
  outcome.report = timed.estimator().report();
  outcome.map = timed.estimator().map_points();
  outcome.scores =
      score(outcome.report.trajectory, result.truth_trajectory, result.truth.passages, scoring);
  outcome.weak_axis =
      weak_axis_scores_of(outcome.report, result.truth_trajectory, result.localizability, scoring,
                          half_sweep(scenario.simulation));
  outcome.scan_times_ms = timed.scan_times_ms();
  outcome.wall_s = timed.total_seconds();
  return outcome;
}

}  // namespace

Result<RunResult> run(const Scenario& scenario, const RunOptions& options,
                      const Observer& observer) {
  const Stopwatch stopwatch;
  auto simulation = Simulation::create(scenario.simulation, options.seed);
  if (!simulation) return tl::unexpected(located(scenario, simulation.error()));
  auto estimators = make_estimators(scenario, simulation->rig());
  if (!estimators) return tl::unexpected(estimators.error());

  RunResult result;
  result.seed = options.seed;
  result.complete = stream(*simulation, *estimators, options.jobs, observer);
  result.simulated_s = to_seconds(simulation->now());
  result.simulation_times = simulation->times();
  result.scene = simulation->scene();
  result.truth = simulation->truth();
  result.truth_trajectory = body_trajectory(result.truth);
  result.localizability = run_localizability(scenario.simulation, simulation->rig(), result.truth,
                                             result.truth_trajectory);
  for (const TimedEstimator& each : *estimators) {
    result.estimators.push_back(outcome_of(each, result, scenario));
  }
  result.wall_s = stopwatch.seconds();
  return result;
}

}  // namespace aims
