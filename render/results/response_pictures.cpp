// SPDX-License-Identifier: BSD-3-Clause
#include "render/results/response_pictures.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <tuple>
#include <utility>

#include "bench/tuning/response_summary.hpp"
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

std::string value_label(const Objective& objective) {
  return objective.score +
         (objective.relative ? " over the defaults' [-]" : " [unit of the score]");
}

std::string source_text(bool measured) {
  return measured ? "measured; intervals over seeds" : "by a polynomial through the points";
}

LevelCurve level_curve(const Slice& slice) {
  LevelCurve curve{name_of_group(slice.family), {}};
  for (const SlicePoint& point : slice.points) {
    LevelPoint level{point.x, point.objective, std::nullopt, std::nullopt};
    if (slice.measured)
      std::tie(level.low, level.high) = std::pair(point.interval.low, point.interval.high);
    curve.points.push_back(level);
  }
  return curve;
}

/// False when there is nothing to draw.
Result<bool> draw_curve(const ResponseTable& table, const Objective& objective, std::size_t i,
                        const std::filesystem::path& file) {
  LevelPlot plot;
  LevelPanel panel;
  bool measured = false;
  for (const std::string& group : groups_of(table)) {
    const Slice slice = curve_of(table, objective, i, group);
    if (slice.points.empty()) continue;
    measured = slice.measured;
    panel.curves.push_back(level_curve(slice));
  }
  if (panel.curves.empty()) return false;
  plot.title = table.ranges[i].key;
  plot.subtitle =
      fmt::format("{}; others at their defaults; {}", text_of(objective), source_text(measured));
  plot.level_label = fmt::format("{} (default {})", table.ranges[i].key, table.defaults[i]);
  plot.logarithmic_levels = table.ranges[i].log;
  panel.label = value_label(objective);
  panel.logarithmic = true;
  plot.panels.push_back(std::move(panel));
  if (auto written = write_level_plot(file, plot); !written) return tl::unexpected(written.error());
  return true;
}

/// The two parameters with the largest total indices.
std::pair<std::size_t, std::size_t> leading(const ResponseTable& table,
                                            const Objective& objective) {
  const auto sensitivity = sensitivity_of(table, objective);
  if (!sensitivity || !sensitivity->is_reliable()) return {0, 1};
  const auto& total = sensitivity->surrogate.indices().total;
  std::vector<std::size_t> order;
  for (std::size_t i = 0; i < total.size(); ++i) order.push_back(i);
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return total[a] > total[b]; });
  return std::minmax(order[0], order[1]);
}

Result<bool> draw_map(const ResponseTable& table, const Objective& objective, std::size_t first,
                      std::size_t second, const std::filesystem::path& file) {
  FieldPlot plot;
  bool measured = false;
  for (const std::string& group : groups_of(table)) {
    const Slice slice = map_of(table, objective, first, second, group);
    if (slice.points.empty()) continue;
    measured = slice.measured;
    FieldPanel panel{name_of_group(group), {}};
    for (const SlicePoint& point : slice.points) {
      panel.cells.push_back({point.x, point.y, point.objective});
    }
    plot.panels.push_back(std::move(panel));
  }
  if (plot.panels.empty()) return false;
  const ParameterRange& x = table.ranges[first];
  const ParameterRange& y = table.ranges[second];
  plot.title = x.key + " and " + y.key;
  plot.subtitle = fmt::format("{}; {}", text_of(objective),
                              measured ? "measured" : "by a polynomial through the points");
  plot.x_label = x.key;
  plot.y_label = y.key;
  plot.value_label = value_label(objective);
  plot.logarithmic_x = x.log;
  plot.logarithmic_y = y.log;
  plot.logarithmic_value = true;
  plot.marks.push_back({{table.defaults[first], table.defaults[second]}, "default"});
  if (const auto best = best_point(table, objective)) {
    plot.marks.push_back({{best->values[first], best->values[second]}, "best"});
  }
  if (auto written = write_field_plot(file, plot); !written) return tl::unexpected(written.error());
  return true;
}

/// Ends of a scale over positive values with some room; of a logarithmic one.
Axis value_scale(const Objective& objective, const std::vector<double>& values) {
  const auto [least, most] = std::minmax_element(values.begin(), values.end());
  const double room = std::max(1.05, std::pow(*most / *least, 0.08));
  return {value_label(objective), *least / room, *most * room, true};
}

Axis range_axis(const ParameterRange& range) {
  return {range.key, range.low, range.high, range.log};
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
  Figure figure;
  figure.title = "Every point that was run";
  figure.subtitle = text_of(objective) + "; all other parameters differ too";
  figure.width = 1100;
  for (std::size_t i = 0; i < table.ranges.size(); ++i) {
    Panel panel;
    panel.x = range_axis(table.ranges[i]);
    panel.y = value_scale(objective, values);
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

/// Whether each parameter's curve is measured.
bool has_curves(const ResponseTable& table, const Objective& objective) {
  for (std::size_t i = 0; i < table.ranges.size(); ++i) {
    if (!curve_of(table, objective, i).measured) return false;
  }
  return true;
}

}  // namespace

Result<std::vector<std::string>> draw_response(const ResponseTable& table,
                                               const Objective& objective,
                                               const std::filesystem::path& folder) {
  std::vector<std::string> names;
  if (!has_curves(table, objective)) {
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
