// SPDX-License-Identifier: BSD-3-Clause
#include "render/results/pictures.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "bench/run/start_anchor.hpp"
#include "render/plots/trajectory_plot.hpp"
#include "render/results/estimator_pictures.hpp"
#include "render/scene/robot_pictures.hpp"
#include "sim/robot/quadruped_model.hpp"

namespace aims {
namespace {

namespace fs = std::filesystem;

/// Pictures show trajectories at this spacing.
constexpr Duration kDrawnSpacing = 100 * kMillisecond;

std::string subtitle_of(const RunResult& result) {
  return fmt::format("seed {}, {:.0f} s simulated", result.seed, result.simulated_s);
}

Result<void> draw_trajectories(const Scenario& scenario, const RunResult& result,
                               const fs::path& folder) {
  TrajectoryPlot plot;
  plot.title = scenario.name + ": estimated trajectories";
  plot.subtitle = subtitle_of(result);
  plot.scene = result.scene;
  plot.truth = thinned(result.truth_trajectory, kDrawnSpacing);
  plot.waypoint_times = result.truth.waypoint_times;
  for (const EstimatorOutcome& outcome : result.estimators) {
    plot.estimates.push_back({outcome.name, anchored(outcome.result.trajectory,
                                                     result.truth_trajectory, scenario.scoring)});
  }
  return write_trajectory_plot(folder / "trajectories.png", plot);
}

Result<void> draw_robot(const Scenario& scenario, const RunResult& result, const fs::path& folder) {
  const auto drawn = write_robot_pictures(folder, scenario.name, result.scene, quadruped_mjcf(),
                                          result.truth.snapshots);
  if (!drawn) return tl::unexpected(drawn.error());
  return {};
}

}  // namespace

Result<void> draw_pictures(const Scenario& scenario, const RunResult& result,
                           const fs::path& folder) {
  auto drawn = draw_robot(scenario, result, folder);
  if (drawn) drawn = draw_trajectories(scenario, result, folder);
  if (drawn) {
    drawn = draw_degeneracy(scenario.name, subtitle_of(result), result.estimators,
                            result.truth.waypoint_times, folder);
  }
  for (const EstimatorOutcome& outcome : result.estimators) {
    if (drawn) drawn = draw_map(scenario.name, outcome, folder);
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
