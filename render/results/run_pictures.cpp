// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>

#include <algorithm>
#include <functional>
#include <mutex>
#include <span>
#include <utility>

#include "bench/run/sequence.hpp"
#include "bench/scenario/scenario.hpp"
#include "bench/scoring/result_files.hpp"
#include "bench/scoring/score_record.hpp"
#include "bench/scoring/start_anchor.hpp"
#include "core/background_tasks.hpp"
#include "core/files/manifest.hpp"
#include "estimator/estimator_spec.hpp"
#include "render/plots/map_grid.hpp"
#include "render/plots/trajectory_plot.hpp"
#include "render/results/estimator_pictures.hpp"
#include "render/results/pictures.hpp"
#include "render/scene/robot_pictures.hpp"
#include "sim/robot/robot_config.hpp"

namespace aims {
namespace {

namespace fs = std::filesystem;

/// A picture, or some that are drawn together.
struct Picture {
  std::filesystem::path file;  ///< the first of them
  std::function<Result<void>()> draw;
};

/// Draws the pictures, on two threads when `threads` is more than one: begin with what takes
/// longest. The pixels do not depend on it; `observer` is called by one thread at a time. After an
/// error no other picture is begun; returns that of the first in the list.
Result<void> draw_all(std::span<const Picture> pictures, int threads,
                      const DrawObserver& observer) {
  std::vector<Result<void>> drawn(pictures.size());
  std::mutex mutex;  // of what follows, and of the observer
  std::size_t next = 0;
  bool failed = false;
  const auto draw_some = [&] {
    std::unique_lock lock(mutex);
    while (next < pictures.size() && !failed) {
      const std::size_t own = next++;
      announce(observer, pictures[own].file);
      lock.unlock();
      drawn[own] = pictures[own].draw();
      lock.lock();
      failed = failed || !drawn[own];
    }
  };
  BackgroundTasks second(threads);
  second.add(draw_some);
  draw_some();
  second.wait();
  for (const Result<void>& each : drawn) {
    if (!each) return each;
  }
  return {};
}

/// Pictures show trajectories at this spacing.
constexpr Duration kRunSpacing = 100 * kMillisecond;

/// What a run's pictures show.
struct DrawnRun : WrittenSequence {
  std::vector<RobotSnapshot> snapshots;
  std::vector<EstimatorOutcome> estimators;
  std::string subtitle;
};

/// What is read of an estimator.
using PartsOf = std::function<EstimatorParts(const std::string& label)>;

Result<DrawnRun> read_run(const fs::path& folder, const PartsOf& parts_of) {
  auto sequence = read_sequence(folder);
  if (!sequence) return tl::unexpected(sequence.error());
  DrawnRun run{std::move(*sequence), {}, {}, {}};
  auto snapshots = read_snapshots(folder / "snapshots.csv");
  if (!snapshots) return tl::unexpected(snapshots.error());
  run.snapshots = std::move(*snapshots);
  const auto record = read_record(folder / "scores.json");
  for (const std::string& label : labels_of(run.scenario.run)) {
    if (!fs::exists(folder / (label + ".tum"))) continue;  // it failed
    auto estimator = read_estimator(folder, label, parts_of(label));
    if (!estimator) return tl::unexpected(estimator.error());
    const auto diverged_at = record ? find_score(*record, label, "diverged_at_s") : std::nullopt;
    if (diverged_at) estimator->scores.diverged_at = from_seconds(*diverged_at);
    run.estimators.push_back(std::move(*estimator));
  }
  const double end_s = run.truth.empty() ? 0.0 : to_seconds(run.truth.back().stamp);
  run.subtitle = fmt::format("seed {}, {:.0f} s simulated", run.seed, end_s);
  return run;
}

Result<void> draw_trajectories(const DrawnRun& run, const fs::path& file) {
  TrajectoryPlot plot;
  plot.title = run.scenario.name + ": estimated trajectories";
  plot.subtitle = fmt::format("{}  ·  {}", run.subtitle, kHeadingFitted);
  plot.scene = run.scene;
  plot.truth = thinned(run.truth, kRunSpacing);
  plot.waypoint_times = run.waypoint_times;
  for (const EstimatorOutcome& outcome : run.estimators) {
    const ScoreConfig& scoring = run.scenario.scoring;
    Trajectory start = anchored(outcome.result.trajectory, run.truth, scoring);
    plot.estimates.push_back({outcome.name, heading_fitted(std::move(start), run.truth, scoring,
                                                           outcome.scores.diverged_at)});
  }
  return write_trajectory_plot(file, plot);
}

/// The estimator's map and trajectory, laid onto the truth.
MapPicture map_on_truth(const DrawnRun& run, const EstimatorOutcome& outcome) {
  const Trajectory& estimate = outcome.result.trajectory;
  const Pose T_world_odom = start_anchor(estimate, run.truth, run.scenario.scoring);
  MapPicture map;
  map.title = outcome.name;
  for (const Eigen::Vector3f& point : outcome.map) {
    map.points.push_back((T_world_odom * point.cast<double>()).cast<float>());
  }
  map.trajectory = thinned(anchored(estimate, run.truth, run.scenario.scoring), kRunSpacing);
  return map;
}

Result<void> draw_maps(const DrawnRun& run, const std::vector<std::string>& names,
                       const fs::path& file) {
  MapGrid grid;
  grid.title = run.scenario.name + ": maps";
  grid.subtitle = run.subtitle +
                  "  ·  aligned by their start alone, equal scales; white: trajectory, "
                  "dot: its start";
  grid.truth = run.truth;
  for (const std::string& name : names) {
    const auto found = std::ranges::find(run.estimators, name, &EstimatorOutcome::name);
    if (found != run.estimators.end()) grid.maps.push_back(map_on_truth(run, *found));
  }
  return grid.maps.empty() ? Result<void>() : write_map_grid(file, grid);
}

Result<void> draw_robot(const DrawnRun& run, const fs::path& folder) {
  const auto robot = robot_model(run.scenario.simulation.robot.model);
  if (!robot) return tl::unexpected(robot.error());
  const auto drawn =
      write_robot_pictures(folder, run.scenario.name, run.scene, robot->mjcf, run.snapshots);
  if (!drawn) return tl::unexpected(drawn.error());
  return {};
}

/// Of the first estimator that reports it.
Result<void> draw_first_degeneracy(const DrawnRun& run, const fs::path& folder) {
  for (const EstimatorOutcome& each : run.estimators) {
    const auto drawn =
        draw_degeneracy(run.scenario.name, run.subtitle, each, run.waypoint_times, folder);
    if (!drawn) return tl::unexpected(drawn.error());
    if (*drawn) break;
  }
  return {};
}

/// Lists the pictures of the run in the manifest of its folder: the next run there removes them.
void list_pictures(const DrawnRun& run, const fs::path& folder) {
  std::vector<std::string> names = {"robot_start.png", "robot_middle.png", "robot_turn.png",
                                    "trajectories.png", "degeneracy.png"};
  for (const EstimatorOutcome& each : run.estimators) {
    for (const char* view : {"top", "side"}) {
      names.push_back(fmt::format("{}-map-{}.png", each.name, view));
    }
  }
  std::error_code ignored;
  for (const std::string& name : names) {
    if (fs::exists(folder / name, ignored)) add_to_manifest(folder / name);
  }
}

}  // namespace

Result<void> draw_run(const fs::path& folder, const DrawObserver& observer, int threads) {
  const auto run = read_run(folder, [](const std::string&) { return EstimatorParts{}; });
  if (!run) return tl::unexpected(run.error());
  const fs::path trajectories = folder / "trajectories.png";
  std::vector<Picture> pictures = {
      {folder / "robot_start.png", [&] { return draw_robot(*run, folder); }},
      {trajectories, [&] { return draw_trajectories(*run, trajectories); }},
      {folder / "degeneracy.png", [&] { return draw_first_degeneracy(*run, folder); }}};
  for (const EstimatorOutcome& each : run->estimators) {
    pictures.push_back({folder / (each.name + "-map-top.png"),
                        [&] { return draw_map(run->scenario.name, each, folder); }});
  }
  auto drawn = draw_all(pictures, threads, observer);
  list_pictures(*run, folder);
  return drawn;
}

Result<void> draw_systems(const fs::path& folder, const std::vector<std::string>& maps,
                          const fs::path& out, const DrawObserver& observer) {
  const auto run = read_run(folder, [&maps](const std::string& label) {
    return EstimatorParts{.diagnostics = false, .map = std::ranges::count(maps, label) > 0};
  });
  if (!run) return tl::unexpected(run.error());
  const fs::path trajectories = out / (run->scenario.name + "-trajectories.png");
  announce(observer, trajectories);
  if (auto drawn = draw_trajectories(*run, trajectories); !drawn) return drawn;
  const fs::path side_by_side = out / (run->scenario.name + "-maps.png");
  announce(observer, side_by_side);
  return draw_maps(*run, maps, side_by_side);
}

std::vector<fs::path> pictures_in(const fs::path& folder) {
  std::vector<fs::path> pictures;
  for (const auto& entry : fs::recursive_directory_iterator(folder)) {
    if (entry.path().extension() == ".png") pictures.push_back(entry.path());
  }
  std::sort(pictures.begin(), pictures.end());
  return pictures;
}

}  // namespace aims
