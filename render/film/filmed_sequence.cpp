// SPDX-License-Identifier: BSD-3-Clause
#include "render/film/filmed_sequence.hpp"

#include "bench/metrics/association.hpp"
#include "bench/run/start_anchor.hpp"
#include "bench/run/stream.hpp"
#include "core/stopwatch.hpp"
#include "sim/simulation.hpp"

namespace aims {
namespace {

constexpr Duration kDrawnSpacing = 100 * kMillisecond;

void hand_over(const std::vector<Delivery>& batch, std::size_t from,
               std::vector<LidarScanPtr>& to) {
  for (std::size_t i = from; i < batch.size(); ++i) {
    const auto* scan = std::get_if<LidarScanPtr>(&batch[i].measurement);
    if (scan != nullptr) to.push_back(*scan);
  }
}

FilmedSequence sequence_of(const Scenario& scenario, const Simulation& simulation,
                           const std::vector<TimedEstimator>& estimators) {
  FilmedSequence sequence;
  sequence.scenario = scenario.name;
  sequence.robot = scenario.simulation.robot.model;
  sequence.scene = simulation.scene();
  const Trajectory truth = body_trajectory(simulation.truth());
  sequence.truth = thinned(truth, kDrawnSpacing);
  sequence.snapshots = simulation.truth().snapshots;
  sequence.waypoint_times = simulation.truth().waypoint_times;
  for (const TimedEstimator& each : estimators) {
    sequence.estimates.push_back(
        {each.name(), anchored(each.estimator().result().trajectory, truth, scenario.scoring)});
  }
  return sequence;
}

}  // namespace

Result<FilmedSequence> film_sequence(const Scenario& given, const RunOptions& options,
                                     const Observer& observer) {
  const Stopwatch stopwatch;
  const Scenario scenario = scenario_of_seed(given, options.seed);
  auto simulation = Simulation::create(scenario.simulation, options.seed);
  if (!simulation) return tl::unexpected(located(scenario, simulation.error()));
  auto estimators = make_estimators(scenario.run, scenario.estimators, simulation->rig());
  if (!estimators) return tl::unexpected(estimators.error());
  if (estimators->empty()) return failure("estimators: expected at least one to make the map");
  const auto result = [&]() -> const EstimatorResult& {
    return estimators->front().estimator().result();
  };
  MapGrowth growth(simulation->rig().T_body_lidar);
  std::vector<LidarScanPtr> scans;  // while estimators work on one batch the next is simulated
  const double expected_s = to_seconds(simulation->expected_duration());
  const StreamEnd end = stream(
      [&](std::vector<Delivery>& batch) {
        const std::size_t from = batch.size();
        const bool more = simulation->advance(kStreamBatch, batch);
        hand_over(batch, from, scans);
        return more;
      },
      *estimators, options.jobs,
      [&] {
        for (const LidarScanPtr& scan : scans) growth.add(scan);
        scans.clear();
        growth.settle(result().trajectory);
        return observer({to_seconds(simulation->now()), expected_s, stopwatch.seconds()});
      });
  growth.settle(result().trajectory);
  FilmedSequence sequence = sequence_of(scenario, *simulation, *estimators);
  sequence.seed = options.seed;
  sequence.complete = !end.stopped;
  sequence.map = growth.points();
  const Pose T_world_odom =
      start_anchor(result().trajectory, body_trajectory(simulation->truth()), scenario.scoring);
  for (GrownPoint& point : sequence.map) {
    point.position = (T_world_odom * point.position.cast<double>()).cast<float>();
  }
  return sequence;
}

}  // namespace aims
