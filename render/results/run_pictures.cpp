// SPDX-License-Identifier: BSD-3-Clause
#include "render/results/run_pictures.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "bench/run/results.hpp"
#include "bench/run/scenario.hpp"
#include "bench/run/sequence.hpp"
#include "bench/run/start_anchor.hpp"
#include "core/files/atomic_file.hpp"
#include "core/files/tum.hpp"
#include "core/files/waypoint_times.hpp"
#include "estimator/estimator_spec.hpp"
#include "render/plots/trajectory_plot.hpp"
#include "render/results/estimator_pictures.hpp"
#include "render/scene/robot_pictures.hpp"
#include "sim/environment/scene_config.hpp"
#include "sim/robot/quadruped_model.hpp"

namespace aims {
namespace {

namespace fs = std::filesystem;

/// Pictures show trajectories at this spacing.
constexpr Duration kRunSpacing = 100 * kMillisecond;

/// What a run's pictures show.
struct DrawnRun {
  Scenario scenario;
  Scene scene;
  Trajectory truth;
  std::vector<WaypointTime> waypoint_times;
  std::vector<RobotSnapshot> snapshots;
  std::vector<EstimatorOutcome> estimators;
  std::string subtitle;
};

Result<DrawnRun> read_run(const fs::path& folder) {
  auto scenario = load_scenario(folder / "config.yaml", {});
  if (!scenario) return tl::unexpected(scenario.error());
  DrawnRun run;
  run.scenario = std::move(*scenario);
  const auto seed = static_cast<std::uint64_t>(run.scenario.seed);
  run.scene = build_scene(run.scenario.simulation.scene, seed);
  auto truth = read_tum(folder / "truth.tum");
  if (!truth) return tl::unexpected(truth.error());
  run.truth = std::move(*truth);
  const fs::path times = folder / "waypoint_times.csv";
  const auto text = read_file(times);
  if (!text) return tl::unexpected(text.error());
  auto waypoint_times = parse_waypoint_times(*text, times.string());
  if (!waypoint_times) return tl::unexpected(waypoint_times.error());
  run.waypoint_times = std::move(*waypoint_times);
  auto snapshots = read_snapshots(folder / "snapshots.csv");
  if (!snapshots) return tl::unexpected(snapshots.error());
  run.snapshots = std::move(*snapshots);
  for (const std::string& label : labels_of(run.scenario.run)) {
    if (!fs::exists(folder / (label + ".tum"))) continue;  // it failed
    auto estimator = read_estimator(folder, label);
    if (!estimator) return tl::unexpected(estimator.error());
    run.estimators.push_back(std::move(*estimator));
  }
  const double end_s = run.truth.empty() ? 0.0 : to_seconds(run.truth.back().stamp);
  run.subtitle = fmt::format("seed {}, {:.0f} s simulated", seed, end_s);
  return run;
}

Result<void> draw_trajectories(const DrawnRun& run, const fs::path& folder) {
  TrajectoryPlot plot;
  plot.title = run.scenario.name + ": estimated trajectories";
  plot.subtitle = run.subtitle;
  plot.scene = run.scene;
  plot.truth = thinned(run.truth, kRunSpacing);
  plot.waypoint_times = run.waypoint_times;
  for (const EstimatorOutcome& outcome : run.estimators) {
    plot.estimates.push_back(
        {outcome.name, anchored(outcome.result.trajectory, run.truth, run.scenario.scoring)});
  }
  return write_trajectory_plot(folder / "trajectories.png", plot);
}

Result<void> draw_robot(const DrawnRun& run, const fs::path& folder) {
  const auto drawn =
      write_robot_pictures(folder, run.scenario.name, run.scene, quadruped_mjcf(), run.snapshots);
  if (!drawn) return tl::unexpected(drawn.error());
  return {};
}

}  // namespace

Result<void> draw_run(const fs::path& folder, const DrawObserver& observer) {
  const auto run = read_run(folder);
  if (!run) return tl::unexpected(run.error());
  announce(observer, folder / "robot_start.png");
  auto drawn = draw_robot(*run, folder);
  if (drawn) {
    announce(observer, folder / "trajectories.png");
    drawn = draw_trajectories(*run, folder);
  }
  if (drawn) {
    announce(observer, folder / "degeneracy.png");
    drawn = draw_degeneracy(run->scenario.name, run->subtitle, run->estimators, run->waypoint_times,
                            folder);
  }
  for (const EstimatorOutcome& outcome : run->estimators) {
    if (!drawn) break;
    announce(observer, folder / (outcome.name + "-map-top.png"));
    drawn = draw_map(run->scenario.name, outcome, folder);
  }
  return drawn;
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
