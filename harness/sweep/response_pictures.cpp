// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>

#include <algorithm>
#include <tuple>
#include <utility>

#include "harness/sweep/response_report.hpp"
#include "render/field_plot.hpp"
#include "render/level_plot.hpp"

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
  if (!sensitivity || !sensitivity->trustworthy()) return {0, 1};
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

}  // namespace

Result<std::vector<std::string>> draw_response(const ResponseTable& table,
                                               const Objective& objective,
                                               const std::filesystem::path& folder) {
  std::vector<std::string> names;
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
