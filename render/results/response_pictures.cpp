// SPDX-License-Identifier: BSD-3-Clause
#include "render/results/response_pictures.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <tuple>
#include <utility>

#include "bench/tuning/analysis.hpp"
#include "bench/tuning/sensitivity.hpp"
#include "bench/tuning/slice.hpp"
#include "render/plots/field_plot.hpp"
#include "render/plots/level_plot.hpp"
#include "render/plots/plot.hpp"

namespace aims {
namespace {

constexpr std::size_t kMostFamilies = 6;  ///< curves of a picture besides that of all

/// Whose slices are drawn: all, then the families where there are several.
std::vector<std::string> groups_of(const ResponseTable& table) {
  std::vector<std::string> groups = {""};
  const auto families = families_of(table);
  if (families.size() < 2) return groups;
  groups.insert(groups.end(), families.begin(), families.end());
  if (groups.size() > kMostFamilies + 1) groups.resize(kMostFamilies + 1);
  return groups;
}

std::string name_of_group(const std::string& family) { return family.empty() ? "all" : family; }

LevelPoint level_point(const SlicePoint& point) {
  return {point.x, point.objective, point.interval.low, point.interval.high};
}

LevelCurve level_curve(const Slice& slice) {
  LevelCurve curve{name_of_group(slice.family), {}};
  for (const SlicePoint& point : slice.measured) curve.points.push_back(level_point(point));
  for (const SlicePoint& point : slice.fit) curve.fit.push_back(level_point(point));
  return curve;
}

/// "markers: measured, with intervals over seeds; thin line: fit; kappa = 10 (default 12.6)".
std::string curve_text(const ResponseTable& table, const std::vector<Slice>& slices) {
  const bool fitted = std::any_of(slices.begin(), slices.end(),
                                  [](const Slice& slice) { return !slice.fit.empty(); });
  const std::string held = held_text(table, slices.front());
  return fmt::format("markers: measured, with intervals over seeds{}{}",
                     fitted ? "; thin line: fit" : "", held.empty() ? "" : "; " + held);
}

/// False when there is nothing to draw.
Result<bool> draw_curve(const ResponseTable& table, const Objective& objective, std::size_t i,
                        const std::filesystem::path& file) {
  LevelPlot plot;
  LevelPanel panel;
  std::vector<Slice> slices;
  for (const std::string& group : groups_of(table)) {
    Slice slice = curve_of(table, objective, i, group);
    if (slice.is_empty()) continue;
    panel.curves.push_back(level_curve(slice));
    slices.push_back(std::move(slice));
  }
  if (slices.empty()) return false;
  plot.title = table.ranges[i].key;
  plot.unjoined = true;
  plot.subtitle = curve_text(table, slices);
  plot.level_label = fmt::format("{} (default {})", table.ranges[i].key, table.defaults[i]);
  plot.logarithmic_levels = table.ranges[i].log;
  panel.label = axis_label(objective);
  panel.logarithmic = true;
  plot.panels.push_back(std::move(panel));
  if (auto written = write_level_plot(file, plot); !written) return tl::unexpected(written.error());
  return true;
}

/// The two parameters with the largest total indices.
std::pair<std::size_t, std::size_t> leading(const ResponseTable& table,
                                            const Objective& objective) {
  const auto sensitivity = sensitivity_of(table, objective);
  if (!sensitivity || !sensitivity->is_resolved()) return {0, 1};
  const auto& total = sensitivity->indices.total;
  std::vector<std::size_t> order;
  for (std::size_t i = 0; i < total.size(); ++i) order.push_back(i);
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return total[a] > total[b]; });
  return std::minmax(order[0], order[1]);
}

/// Whether a point lies on the map: but for the two parameters, it has what the map holds.
bool shows(const std::vector<double>& point, const std::vector<double>& held, std::size_t first,
           std::size_t second) {
  for (std::size_t i = 0; i < point.size(); ++i) {
    if (i != first && i != second && point[i] != held[i]) return false;
  }
  return true;
}

Result<bool> draw_map(const ResponseTable& table, const Objective& objective, std::size_t first,
                      std::size_t second, const std::filesystem::path& file) {
  FieldPlot plot;
  bool measured = false;
  std::string held;
  std::vector<double> held_at;
  for (const std::string& group : groups_of(table)) {
    const Slice slice = map_of(table, objective, first, second, group);
    if (slice.is_empty()) continue;
    measured = !slice.measured.empty();
    held = held_text(table, slice);
    held_at = slice.held;
    FieldPanel panel{name_of_group(group), {}};
    for (const SlicePoint& point : measured ? slice.measured : slice.fit) {
      panel.cells.push_back({point.x, point.y, point.objective});
    }
    plot.panels.push_back(std::move(panel));
  }
  if (plot.panels.empty()) return false;
  const ParameterRange& x = table.ranges[first];
  const ParameterRange& y = table.ranges[second];
  plot.title = x.key + " and " + y.key;
  plot.subtitle = fmt::format("{}; {}{}", text_of(objective), measured ? "measured" : "by a fit",
                              held.empty() ? "" : "; " + held);
  plot.x_label = x.key;
  plot.y_label = y.key;
  plot.value_label = axis_label(objective);
  plot.logarithmic_x = x.log;
  plot.logarithmic_y = y.log;
  plot.logarithmic_value = true;
  plot.marks.push_back({{table.defaults[first], table.defaults[second]}, "default"});
  const auto best = best_point(table, objective);
  if (best && shows(best->values, held_at, first, second)) {
    plot.marks.push_back({{best->values[first], best->values[second]}, "best"});
  }
  if (auto written = write_field_plot(file, plot); !written) return tl::unexpected(written.error());
  return true;
}

/// Ends of a scale over positive values with some room; of a logarithmic one.
Axis value_scale(const Objective& objective, const std::vector<double>& values) {
  const auto [least, most] = std::minmax_element(values.begin(), values.end());
  const double room = std::max(1.05, std::pow(*most / *least, 0.08));
  return {axis_label(objective), *least / room, *most * room, true};
}

/// The range and the default, with room for markers at the ends.
Axis range_axis(const ParameterRange& range, double preset) {
  constexpr double kRoom = 0.03;
  const bool shown = !range.log || preset > 0.0;
  const double low = shown ? std::min(range.low, preset) : range.low;
  const double high = shown ? std::max(range.high, preset) : range.high;
  if (range.log) {
    const double factor = std::max(1.05, std::pow(high / low, kRoom));
    return {range.key, low / factor, high * factor, true};
  }
  const double room = high > low ? kRoom * (high - low) : 0.5;
  return {range.key, low - room, high + room, false};
}

/// Every point that was run, over each parameter: what there is where no curve can be drawn. False
/// where a value has no logarithm.
Result<bool> draw_points(const ResponseTable& table, const Objective& objective,
                         const std::filesystem::path& file) {
  const auto cases = cases_of(table, "");
  std::vector<std::size_t> points;
  std::vector<double> values;
  for (std::size_t k = 0; k < table.points.size(); ++k) {
    const auto value = objective_at(table, objective, k, cases);
    if (!value) continue;
    if (!(*value > 0.0)) return false;
    points.push_back(k);
    values.push_back(*value);
  }
  const auto best = best_point(table, objective);
  if (values.empty() || !best) return false;
  std::vector<double> shown = values;
  if (best->defaults && *best->defaults > 0.0) shown.push_back(*best->defaults);
  Figure figure;
  figure.title = "Every point that was run";
  figure.subtitle = text_of(objective) + "; all other parameters differ too";
  figure.width = 1100;
  for (std::size_t i = 0; i < table.ranges.size(); ++i) {
    Panel panel;
    panel.x = range_axis(table.ranges[i], table.defaults[i]);
    panel.y = value_scale(objective, shown);
    panel.height = 170.0;
    Series dots{"", {}, {series_color(0), 0.0}, 3.5};
    for (std::size_t k = 0; k < points.size(); ++k) {
      dots.points.emplace_back(table.points[points[k]][i], values[k]);
    }
    panel.series.push_back(std::move(dots));
    panel.marks.push_back({{best->values[i], best->objective}, "best"});
    if (best->defaults) panel.marks.push_back({{table.defaults[i], *best->defaults}, "default"});
    figure.panels.push_back(std::move(panel));
  }
  if (auto written = write_figure(file, figure); !written) return tl::unexpected(written.error());
  return true;
}

/// Whether the points are a complete grid, which curves and maps show.
bool is_grid(const ResponseTable& table, const Objective& objective) {
  const auto sensitivity = sensitivity_of(table, objective);
  return sensitivity && sensitivity->of_grid;
}

}  // namespace

Result<std::vector<std::string>> draw_response(const ResponseTable& table,
                                               const Objective& objective,
                                               const std::filesystem::path& folder) {
  std::vector<std::string> names;
  if (!is_grid(table, objective)) {
    const auto drawn = draw_points(table, objective, folder / "points.png");
    if (!drawn) return tl::unexpected(drawn.error());
    if (*drawn) names.push_back("points.png");
  }
  for (std::size_t i = 0; i < table.ranges.size(); ++i) {
    const std::string name = table.ranges[i].key + ".png";
    const auto drawn = draw_curve(table, objective, i, folder / name);
    if (!drawn) return tl::unexpected(drawn.error());
    if (*drawn) names.push_back(name);
  }
  if (table.ranges.size() < 2) return names;
  const auto [first, second] = leading(table, objective);
  const std::string name = table.ranges[first].key + "-" + table.ranges[second].key + ".png";
  const auto drawn = draw_map(table, objective, first, second, folder / name);
  if (!drawn) return tl::unexpected(drawn.error());
  if (*drawn) names.push_back(name);
  return names;
}

}  // namespace aims
