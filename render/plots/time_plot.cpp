// SPDX-License-Identifier: BSD-3-Clause
#include "render/plots/time_plot.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "render/plots/plot.hpp"

namespace aims {
namespace {

/// Values of the panel that its axis can show, in increasing order.
std::vector<double> sorted_values(const TimePanel& panel) {
  std::vector<double> values;
  for (const TimeSeries& series : panel.series) {
    for (const Eigen::Vector2d& point : series.points) {
      if (std::isfinite(point.x()) && is_shown(point.y(), panel.logarithmic)) {
        values.push_back(point.y());
      }
    }
  }
  std::sort(values.begin(), values.end());
  return values;
}

Axis value_axis(const TimePanel& panel) {
  const std::vector<double> values = sorted_values(panel);
  Axis axis{panel.label, panel.logarithmic ? 0.1 : 0.0, 1.0, panel.logarithmic};
  if (values.empty()) return axis;
  const std::size_t cut = values.size() / 500;
  const double low = values[cut];
  const double high = values[values.size() - 1 - cut];
  if (panel.logarithmic) {
    axis.min = low / 1.3;
    axis.max = high * 1.3;
    return axis;
  }
  axis.min = panel.from_zero ? std::min(0.0, low) : low;
  axis.max = panel.from_zero ? std::max(0.0, high) : high;
  const double span = axis.max - axis.min;
  const double margin = span > 0.0 ? 0.06 * span : std::max(0.5, 0.1 * std::abs(axis.max));
  if (!(panel.from_zero && axis.min == 0.0)) axis.min -= margin;
  axis.max += margin;
  return axis;
}

Axis time_axis(const TimePlot& plot) {
  Axis axis{"time [s]", 0.0, 0.0};
  for (const TimePanel& panel : plot.panels) {
    for (const TimeSeries& series : panel.series) {
      for (const Eigen::Vector2d& point : series.points) {
        if (std::isfinite(point.x())) axis.max = std::max(axis.max, point.x());
      }
    }
  }
  axis.max = axis.max > 0.0 ? 1.005 * axis.max : 1.0;
  return axis;
}

Panel panel_of(const TimePlot& plot, const TimePanel& source, const Axis& time) {
  Panel panel{.title = source.title, .x = time, .y = value_axis(source)};
  panel.height = 170.0;
  panel.own_legend = true;
  std::vector<std::string> names;
  for (const TimeSeries& each : source.series) names.push_back(each.name);
  std::vector<Stroke> strokes = series_strokes(names);
  for (std::size_t i = 0; i < source.series.size(); ++i) {
    if (!plot.of_estimators) strokes[i] = series_stroke(i, i == 0 ? 1.4 : 2.0);
    panel.series.push_back({source.series[i].name, source.series[i].points, strokes[i]});
  }
  for (const auto& [at, label] : plot.events) panel.events.push_back({at, label});
  return panel;
}

}  // namespace

Result<void> write_time_plot(const std::filesystem::path& path, const TimePlot& plot) {
  Figure figure{.title = plot.title, .subtitle = plot.subtitle};
  const Axis time = time_axis(plot);
  for (const TimePanel& panel : plot.panels) figure.panels.push_back(panel_of(plot, panel, time));
  return write_figure(path, figure);
}

}  // namespace aims
