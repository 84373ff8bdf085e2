// SPDX-License-Identifier: BSD-3-Clause
#include "render/plots/level_plot.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "render/plots/plot.hpp"

namespace aims {
namespace {

constexpr double kDot = 4.0;            ///< radius [px]
constexpr double kPanelHeight = 260.0;  ///< [px]

void include(Extent& extent, const std::optional<double>& value, bool logarithmic) {
  if (value && is_shown(*value, logarithmic)) extent.include(*value);
}

/// The axis around the extent, with a margin [fraction of the span].
Axis axis_of(const std::string& label, Extent extent, bool logarithmic, double margin) {
  if (extent.empty()) extent = logarithmic ? Extent{0.1, 1.0} : Extent{0.0, 1.0};
  if (logarithmic) {
    const double factor = std::max(std::pow(extent.max / extent.min, margin), 1.2);
    return {label, extent.min / factor, extent.max * factor, true};
  }
  const double span = extent.span();
  const double room = span > 0.0 ? margin * span : std::max(0.5, 0.1 * std::abs(extent.max));
  return {label, extent.min - room, extent.max + room, false};
}

Axis level_axis(const LevelPlot& plot) {
  Extent extent;
  for (const LevelPanel& panel : plot.panels) {
    for (const LevelCurve& curve : panel.curves) {
      for (const auto* points : {&curve.points, &curve.fit}) {
        for (const LevelPoint& point : *points) {
          include(extent, point.level, plot.logarithmic_levels);
        }
      }
    }
  }
  return axis_of(plot.level_label, extent, plot.logarithmic_levels, 0.05);
}

Axis value_axis(const LevelPanel& panel) {
  if (panel.rate) return {panel.label, -0.05, 1.05, false};
  Extent extent;
  for (const LevelCurve& curve : panel.curves) {
    for (const auto* points : {&curve.points, &curve.fit}) {
      for (const LevelPoint& point : *points) {
        for (const auto& value : {point.value, point.low, point.high}) {
          include(extent, value, panel.logarithmic);
        }
      }
    }
  }
  return axis_of(panel.label, extent, panel.logarithmic, 0.06);
}

/// The level, moved by `steps` small parts of the axis.
double apart(const Axis& axis, double level, double steps) {
  constexpr double kStep = 0.006;
  if (axis.logarithmic) return level * std::pow(axis.max / axis.min, kStep * steps);
  return level + (axis.max - axis.min) * kStep * steps;
}

void add_curve(const LevelCurve& curve, const Stroke& stroke, double steps, Panel& panel) {
  Series line{.name = curve.name, .points = {}, .stroke = stroke, .dot = kDot};
  const double none = std::numeric_limits<double>::quiet_NaN();
  for (const LevelPoint& point : curve.points) {
    const double x = apart(panel.x, point.level, steps);
    line.points.emplace_back(x, point.value.value_or(none));
    if (!point.low || !point.high) continue;
    const double floor = panel.y.logarithmic ? panel.y.min : -std::numeric_limits<double>::max();
    panel.series.push_back({.name = "",
                            .points = {{x, std::max(*point.low, floor)}, {x, *point.high}},
                            .stroke = {stroke.color, 1.2}});
  }
  panel.series.push_back(std::move(line));
}

void add_fit(const LevelCurve& curve, const Color& color, Panel& panel) {
  if (curve.fit.empty()) return;
  const double none = std::numeric_limits<double>::quiet_NaN();
  Series line{.name = "", .points = {}, .stroke = {color, 1.0}};
  Series low = line;
  Series high = line;
  low.stroke.style = high.stroke.style = LineStyle::kDashed;
  for (const LevelPoint& point : curve.fit) {
    line.points.emplace_back(point.level, point.value.value_or(none));
    low.points.emplace_back(point.level, point.low.value_or(none));
    high.points.emplace_back(point.level, point.high.value_or(none));
  }
  for (Series* each : {&line, &low, &high}) panel.series.push_back(std::move(*each));
}

/// Strokes of the curves.
std::vector<Stroke> strokes_of(const LevelPlot& plot, const LevelPanel& panel) {
  std::vector<std::string> names;
  for (const LevelCurve& curve : panel.curves) names.push_back(curve.name);
  std::vector<Stroke> strokes = series_strokes(names, 1.8);
  for (std::size_t i = 0; i < strokes.size() && !plot.of_estimators; ++i) {
    strokes[i] = {series_color(i), 1.8};
  }
  return strokes;
}

Panel panel_of(const LevelPlot& plot, const LevelPanel& source, const Axis& levels) {
  Panel panel{.title = source.title, .x = levels, .y = value_axis(source)};
  panel.height = kPanelHeight;
  const double middle = 0.5 * (static_cast<double>(source.curves.size()) - 1.0);
  std::vector<Stroke> strokes = strokes_of(plot, source);
  if (plot.unjoined) {
    for (Stroke& each : strokes) each.width = 0.0;
  }
  for (std::size_t i = 0; i < source.curves.size(); ++i) {
    add_fit(source.curves[i], strokes[i].color, panel);
    add_curve(source.curves[i], strokes[i], static_cast<double>(i) - middle, panel);
  }
  return panel;
}

}  // namespace

Result<void> write_level_plot(const std::filesystem::path& path, const LevelPlot& plot) {
  Figure figure{.title = plot.title, .subtitle = plot.subtitle};
  figure.width = 1100;
  const Axis levels = level_axis(plot);
  for (const LevelPanel& panel : plot.panels)
    figure.panels.push_back(panel_of(plot, panel, levels));
  if (!plot.panels.empty()) {
    const auto& curves = plot.panels.front().curves;
    const std::vector<Stroke> strokes = strokes_of(plot, plot.panels.front());
    for (std::size_t i = 0; i < curves.size(); ++i) {
      figure.legend.push_back({curves[i].name, strokes[i]});
    }
  }
  return write_figure(path, figure);
}

}  // namespace aims
