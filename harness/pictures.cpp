// SPDX-License-Identifier: BSD-3-Clause
#include "harness/pictures.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "eval/alignment.hpp"
#include "render/map_picture.hpp"
#include "render/robot_pictures.hpp"
#include "render/time_plot.hpp"
#include "render/trajectory_plot.hpp"
#include "sim/quadruped_model.hpp"

namespace aims {
namespace {

namespace fs = std::filesystem;

/// Pictures show trajectories at this spacing.
constexpr Duration kDrawnSpacing = 100 * kMillisecond;

std::string subtitle_of(const RunResult& result) {
  return fmt::format("seed {}, {:.0f} s simulated", result.seed, result.simulated_s);
}

/// The estimate laid onto the truth at its start, by position and heading.
Trajectory in_world(const EstimatorOutcome& outcome, const RunResult& result,
                    const ScoreConfig& scoring) {
  Trajectory estimate = valid_part(outcome.report.trajectory);
  const auto pairs = associate(estimate, result.truth_trajectory, scoring.association,
                               from_seconds(scoring.association_tolerance));
  const Pose T_world_odom = align_start(pairs, scoring.anchor).T_truth_estimate;
  for (StampedPose& each : estimate) each.pose = T_world_odom * each.pose;
  return estimate;
}

Result<void> draw_trajectories(const Scenario& scenario, const RunResult& result,
                               const fs::path& folder) {
  TrajectoryPlot plot;
  plot.title = scenario.name + ": estimated trajectories";
  plot.subtitle = subtitle_of(result);
  plot.scene = result.scene;
  plot.truth = thinned(result.truth_trajectory, kDrawnSpacing);
  plot.passages = result.truth.passages;
  for (const EstimatorOutcome& outcome : result.estimators) {
    plot.estimates.push_back({outcome.name, in_world(outcome, result, scenario.scoring)});
  }
  return write_trajectory_plot(folder / "trajectories.png", plot);
}

Result<void> draw_map(const Scenario& scenario, const EstimatorOutcome& outcome,
                      const fs::path& folder) {
  if (outcome.map.empty()) return {};
  MapPicture map;
  map.title = fmt::format("{}: map of {}", scenario.name, outcome.name);
  map.points = outcome.map;
  map.trajectory = outcome.report.trajectory;
  auto drawn = write_map_picture(folder / (outcome.name + "-map-top.png"), MapView::kAbove, map);
  if (!drawn) return drawn;
  return write_map_picture(folder / (outcome.name + "-map-side.png"), MapView::kSide, map);
}

/// The quantity over the scans that made an update.
TimeSeries series_of(std::string name, const EstimatorOutcome& outcome,
                     double ScanDiagnostics::*quantity) {
  TimeSeries series{std::move(name), {}};
  for (const ScanDiagnostics& scan : outcome.report.diagnostics) {
    const bool updated = scan.iterations > 0;
    if (updated) series.points.emplace_back(to_seconds(scan.stamp), scan.*quantity);
  }
  return series;
}

/// The index and what follows from it, of the first estimator that computes it.
Result<void> draw_degeneracy(const Scenario& scenario, const RunResult& result,
                             const fs::path& folder) {
  const auto found = std::find_if(
      result.estimators.begin(), result.estimators.end(),
      [](const EstimatorOutcome& outcome) { return !outcome.report.diagnostics.empty(); });
  if (found == result.estimators.end()) return {};
  using Scan = ScanDiagnostics;
  TimePlot plot;
  plot.title = fmt::format("{}: degeneracy index of {}", scenario.name, found->name);
  plot.subtitle = subtitle_of(result);
  plot.panels = {
      {"Index",
       "[-]",
       {series_of("D_k", *found, &Scan::D), series_of("smoothed", *found, &Scan::D_smoothed)},
       false,
       true},
      {"Reliability",
       "[-]",
       {series_of("gamma_lidar", *found, &Scan::gamma_lidar),
        series_of("gamma_leg", *found, &Scan::gamma_leg)},
       false,
       true},
      {"Observability",
       "[-]",
       {series_of("O_lidar after the update", *found, &Scan::O_lidar),
        series_of("before", *found, &Scan::O_lidar_prior)},
       false,
       true},
      {"Consistency", "[-]", {series_of("C_IL", *found, &Scan::C_IL)}, true, false},
      {"Smallest translation eigenvalue",
       "[1/m²]",
       {series_of("lambda_min", *found, &Scan::smallest_eigenvalue)},
       true,
       false}};
  for (const Passage& passage : result.truth.passages) {
    plot.events.emplace_back(to_seconds(passage.stamp), passage.point);
  }
  return write_time_plot(folder / "degeneracy.png", plot);
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
  if (drawn) drawn = draw_degeneracy(scenario, result, folder);
  for (const EstimatorOutcome& outcome : result.estimators) {
    if (drawn) drawn = draw_map(scenario, outcome, folder);
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
