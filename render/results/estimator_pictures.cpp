// SPDX-License-Identifier: BSD-3-Clause
#include "render/results/estimator_pictures.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "render/plots/map_picture.hpp"
#include "render/plots/time_plot.hpp"

namespace aims {
namespace {

namespace fs = std::filesystem;

/// A curve: its label and the series that it shows.
struct SeriesCurve {
  const char* label;
  const char* series;
};

/// The series over the scans that have a value of it.
TimeSeries series_of(const SeriesCurve& curve, const Diagnostics& diagnostics) {
  TimeSeries series{curve.label, {}};
  const auto index = diagnostics.find(curve.series);
  if (!index) return series;
  for (std::size_t i = 0; i < diagnostics.scans.size(); ++i) {
    const ScanRow& scan = diagnostics.scans[i];
    const double value = scan.values[*index];
    const bool shown = diagnostics.updated(i) && std::isfinite(value);
    if (shown) series.points.emplace_back(to_seconds(scan.stamp), value);
  }
  return series;
}

/// What an estimator does not compute is the same throughout.
bool varies(const TimeSeries& series) {
  return std::ranges::any_of(
      series.points, [&](const auto& point) { return point.y() != series.points.front().y(); });
}

/// A panel and its curves.
struct SeriesPanel {
  const char* title;
  const char* label;  ///< of the value axis
  std::vector<SeriesCurve> curves;
  bool logarithmic;
  bool from_zero;
};

const std::vector<SeriesPanel> kSeriesPanels = {
    {"Index", "[-]", {{"D_k", "D"}, {"smoothed", "D_smoothed"}}, false, true},
    {"Reliability",
     "[-]",
     {{"gamma_lidar", "gamma_lidar"}, {"gamma_leg", "gamma_leg"}},
     false,
     true},
    {"Observability",
     "[-]",
     {{"O_lidar after the update", "O_lidar"}, {"before", "O_lidar_prior"}},
     false,
     true},
    {"Consistency", "[-]", {{"C_IL", "C_IL"}}, true, false},
    {"Smallest translation eigenvalue",
     "[1/m²]",
     {{"lambda_min", "smallest_eigenvalue"}},
     true,
     false},
    {"Real fraction of the information", "[-]", {{"weakest axis", "weak_weight"}}, false, true},
    {"Estimated IMU noise",
     "[rad/s/√Hz], [m/s²/√Hz]",
     {{"gyro", "gyro_noise"}, {"accelerometer", "accelerometer_noise"}},
     true,
     false},
    {"Estimated delay of the IMU", "[s]", {{"delay", "delay"}}, false, false},
};

/// The panels of those series that have values, and not the same one throughout.
std::vector<TimePanel> panels_of(const Diagnostics& diagnostics) {
  std::vector<TimePanel> panels;
  for (const SeriesPanel& panel : kSeriesPanels) {
    TimePanel drawn{panel.title, panel.label, {}, panel.logarithmic, panel.from_zero};
    for (const SeriesCurve& curve : panel.curves) {
      TimeSeries series = series_of(curve, diagnostics);
      if (!series.points.empty()) drawn.series.push_back(std::move(series));
    }
    if (std::ranges::any_of(drawn.series, varies)) panels.push_back(std::move(drawn));
  }
  return panels;
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

std::vector<std::string> drawn_series() {
  std::vector<std::string> names = {std::string(kIterationsSeries)};
  for (const SeriesPanel& panel : kSeriesPanels) {
    for (const SeriesCurve& curve : panel.curves) names.emplace_back(curve.series);
  }
  return names;
}

Result<bool> draw_degeneracy(const std::string& title, const std::string& subtitle,
                             const EstimatorOutcome& outcome,
                             std::span<const WaypointTime> waypoint_times, const fs::path& folder) {
  TimePlot plot;
  plot.panels = panels_of(outcome.result.diagnostics);
  if (plot.panels.empty()) return false;
  plot.title = fmt::format("{}: degeneracy of {}", title, outcome.name);
  plot.subtitle = subtitle;
  for (const WaypointTime& waypoint_time : waypoint_times) {
    plot.events.emplace_back(to_seconds(waypoint_time.stamp), waypoint_time.point);
  }
  const auto written = write_time_plot(folder / "degeneracy.png", plot);
  if (!written) return tl::unexpected(written.error());
  return true;
}

}  // namespace aims
