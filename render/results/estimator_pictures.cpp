// SPDX-License-Identifier: BSD-3-Clause
#include "render/results/estimator_pictures.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "render/plots/map_picture.hpp"
#include "render/plots/time_plot.hpp"

namespace aims {
namespace {

namespace fs = std::filesystem;

/// The quantity over the scans that made an update.
TimeSeries series_of(std::string name, const EstimatorOutcome& outcome,
                     double ScanDiagnostics::*quantity) {
  TimeSeries series{std::move(name), {}};
  for (const ScanDiagnostics& scan : outcome.result.diagnostics) {
    const bool updated = scan.iterations > 0;
    if (updated) series.points.emplace_back(to_seconds(scan.stamp), scan.*quantity);
  }
  return series;
}

}  // namespace

Result<void> draw_map(const std::string& title, const EstimatorOutcome& outcome,
                      const fs::path& folder) {
  if (outcome.map.empty()) return {};
  MapPicture map;
  map.title = fmt::format("{}: map of {}", title, outcome.name);
  map.points = outcome.map;
  map.trajectory = outcome.result.trajectory;
  auto drawn = write_map_picture(folder / (outcome.name + "-map-top.png"), MapView::kAbove, map);
  if (!drawn) return drawn;
  return write_map_picture(folder / (outcome.name + "-map-side.png"), MapView::kSide, map);
}

/// The index and what follows from it, of the first estimator that computes it.
Result<void> draw_degeneracy(const std::string& title, const std::string& subtitle,
                             std::span<const EstimatorOutcome> outcomes,
                             std::span<const WaypointTime> waypoint_times, const fs::path& folder) {
  const auto found = std::find_if(
      outcomes.begin(), outcomes.end(),
      [](const EstimatorOutcome& outcome) { return !outcome.result.diagnostics.empty(); });
  if (found == outcomes.end()) return {};
  using Scan = ScanDiagnostics;
  TimePlot plot;
  plot.title = fmt::format("{}: degeneracy index of {}", title, found->name);
  plot.subtitle = subtitle;
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
  const TimeSeries ratio = series_of("least over axes", *found, &Scan::weak_ratio);
  const bool judged = std::any_of(ratio.points.begin(), ratio.points.end(),
                                  [](const Eigen::Vector2d& point) { return point.y() > 0.0; });
  if (judged) {
    plot.panels.push_back({"Information over what chance gives", "[-]", {ratio}, true, false});
    plot.panels.push_back({"Weight of the weakest axis",
                           "[-]",
                           {series_of("weak_weight", *found, &Scan::weak_weight)},
                           false,
                           true});
  }
  for (const WaypointTime& waypoint_time : waypoint_times) {
    plot.events.emplace_back(to_seconds(waypoint_time.stamp), waypoint_time.point);
  }
  return write_time_plot(folder / "degeneracy.png", plot);
}

}  // namespace aims
