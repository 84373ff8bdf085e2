// SPDX-License-Identifier: BSD-3-Clause
#include "render/film/filmed_sequence.hpp"

#include <fmt/format.h>
#include <algorithm>
#include <utility>

#include "bench/estimate/stream.hpp"
#include "bench/metrics/association.hpp"
#include "bench/run/sequence.hpp"
#include "bench/scoring/start_anchor.hpp"
#include "core/files/atomic_file.hpp"
#include "core/files/ply.hpp"
#include "core/files/tum.hpp"
#include "core/stopwatch.hpp"
#include "estimator/estimator_spec.hpp"
#include "render/film/map_growth.hpp"
#include "sim/environment/scene_config.hpp"
#include "sim/simulation.hpp"

namespace aims {

namespace {

constexpr Duration kDrawnSpacing = 100 * kMillisecond;

/// The truth that a batch of scans may belong to.
constexpr Duration kRecent = 5 * kSecond;

struct FilmedScan {
  LidarScanPtr scan;
  std::vector<bool> moving;  ///< its returns of people
};

/// The last part of the truth.
Trajectory recent_truth(const Truth& truth) {
  Truth recent;
  const auto is_old = [&](const TruthSample& sample) {
    return sample.stamp < truth.samples.back().stamp - kRecent;
  };
  const auto first = std::partition_point(truth.samples.begin(), truth.samples.end(), is_old);
  recent.samples.assign(first, truth.samples.end());
  return body_trajectory(recent);
}

void hand_over(const std::vector<Delivery>& batch, std::size_t from, const Simulation& simulation,
               std::vector<FilmedScan>& to) {
  const Scene& scene = simulation.scene();
  const Trajectory truth = scene.people.empty() ? Trajectory() : recent_truth(simulation.truth());
  for (std::size_t i = from; i < batch.size(); ++i) {
    const auto* scan = std::get_if<LidarScanPtr>(&batch[i].measurement);
    if (scan == nullptr) continue;
    to.push_back({*scan, moving_returns(**scan, scene, truth, simulation.rig().T_body_lidar)});
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
  std::vector<FilmedScan> scans;  // while estimators work on one batch the next is simulated
  const double expected_s = to_seconds(simulation->expected_duration());
  const StreamEnd end = stream(
      [&](std::vector<Delivery>& batch) {
        const std::size_t from = batch.size();
        const bool more = simulation->advance(kStreamBatch, batch);
        hand_over(batch, from, *simulation, scans);
        return more;
      },
      *estimators, options.jobs,
      [&] {
        for (FilmedScan& each : scans) growth.add(each.scan, std::move(each.moving));
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
  sequence.scans = growth.scans();
  for (PlacedScan& scan : sequence.scans) {
    for (Eigen::Vector3f& p : scan.points) p = (T_world_odom * p.cast<double>()).cast<float>();
  }
  return sequence;
}

namespace {

namespace fs = std::filesystem;

fs::path map_file(const fs::path& folder, const std::string& name) {
  return folder / (name + ".map.ply");
}

/// Puts `mapped` in front, or the first that has a map.
Result<void> order(std::vector<std::string>& names, const fs::path& folder,
                   const std::string& mapped) {
  const auto first = std::find_if(names.begin(), names.end(), [&](const std::string& name) {
    return mapped.empty() ? fs::exists(map_file(folder, name)) : name == mapped;
  });
  if (first == names.end() && !mapped.empty()) {
    return failure(fmt::format("{}: no estimator '{}'; there are {}", folder.string(), mapped,
                               fmt::join(names, ", ")));
  }
  if (first != names.end()) std::rotate(names.begin(), first, first + 1);
  return {};
}

Result<void> add_estimates(FilmedSequence& sequence, const fs::path& folder,
                           const std::vector<std::string>& names, const ScoreConfig& scoring) {
  for (const std::string& name : names) {
    const auto estimate = read_tum(folder / (name + ".tum"), PoseRules::kAsGiven);
    if (!estimate) return tl::unexpected(estimate.error());
    const bool first = sequence.estimates.empty();
    sequence.estimates.push_back({name, anchored(*estimate, sequence.truth, scoring)});
    if (!first || !fs::exists(map_file(folder, name))) continue;
    const auto points = read_ply(map_file(folder, name));
    if (!points) return tl::unexpected(points.error());
    const Pose T_world_odom = start_anchor(*estimate, sequence.truth, scoring);
    for (const Eigen::Vector3f& point : *points) {
      sequence.map.push_back({(T_world_odom * point.cast<double>()).cast<float>(), 0});
    }
  }
  return {};
}

}  // namespace

bool holds_sequence(const fs::path& folder) {
  return fs::is_regular_file(folder / "config.yaml") && fs::is_regular_file(folder / "truth.tum");
}

Result<FilmedSequence> stored_sequence(const fs::path& folder, const std::string& mapped) {
  auto run = read_sequence(folder);
  if (!run) return tl::unexpected(run.error());
  FilmedSequence sequence;
  sequence.scenario = run->scenario.name;
  sequence.robot = run->scenario.simulation.robot.model;
  sequence.seed = run->seed;
  sequence.scene = std::move(run->scene);
  sequence.waypoint_times = std::move(run->waypoint_times);
  sequence.truth = std::move(run->truth);
  std::vector<std::string> names = labels_of(run->scenario.run);
  if (auto ordered = order(names, folder, mapped); !ordered) return tl::unexpected(ordered.error());
  if (auto added = add_estimates(sequence, folder, names, run->scenario.scoring); !added) {
    return tl::unexpected(added.error());
  }
  sequence.truth = thinned(sequence.truth, kDrawnSpacing);
  return sequence;
}

}  // namespace aims
