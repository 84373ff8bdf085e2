// SPDX-License-Identifier: BSD-3-Clause
#include "render/results/family_pictures.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <system_error>

#include "render/plots/level_plot.hpp"

namespace aims {
namespace {

namespace fs = std::filesystem;

constexpr const char* kPictureEndings[] = {".png", ".svg"};

/// The family's curves at `levels`, which may be another quantity than the scenarios' level.
LevelPlot plot_of(const FamilyResult& family, const std::vector<std::optional<double>>& levels) {
  LevelPlot plot;
  plot.of_estimators = true;
  plot.title = family.name;
  plot.subtitle =
      "median over seeds with its 95 % bootstrap interval, success with its Wilson interval";
  plot.panels = {{"ATE yaw", "ATE yaw [m]", {}, true, false},
                 {"M_list over all segments", "M_list [%]", {}, true, false},
                 {"success", "fraction of runs [-]", {}, false, true}};
  for (const FamilyCurve& curve : family.curves) {
    for (LevelPanel& panel : plot.panels) panel.curves.push_back({curve.estimator, {}});
    for (std::size_t i = 0; i < curve.points.size(); ++i) {
      const FamilyPoint& p = curve.points[i];
      if (!levels[i] || p.runs == 0) continue;
      plot.panels[0].curves.back().points.push_back(
          {*levels[i], p.ate_m, p.ate_interval.low, p.ate_interval.high});
      plot.panels[1].curves.back().points.push_back(
          {*levels[i], p.m_list, p.m_list_interval.low, p.m_list_interval.high});
      plot.panels[2].curves.back().points.push_back(
          {*levels[i], p.success_rate, p.success_interval.low, p.success_interval.high});
    }
  }
  return plot;
}

/// Sorts the points of every curve by level, so that lines do not run back.
void sort_points(LevelPlot& plot) {
  for (LevelPanel& panel : plot.panels) {
    for (LevelCurve& curve : panel.curves) {
      std::stable_sort(curve.points.begin(), curve.points.end(),
                       [](const auto& a, const auto& b) { return a.level < b.level; });
    }
  }
}

Result<void> draw(const fs::path& folder, const std::string& name, const LevelPlot& plot) {
  for (const char* ending : kPictureEndings) {
    if (auto drawn = write_level_plot(folder / (name + ending), plot); !drawn) return drawn;
  }
  return {};
}

Result<void> draw_family(const fs::path& folder, const FamilyResult& family) {
  std::vector<std::optional<double>> levels;
  for (const FamilyPoint& point : family.curves.front().points) levels.emplace_back(point.level);
  LevelPlot plot = plot_of(family, levels);
  plot.level_label = fmt::format("{} [{}]", family.name, family.level_unit);
  auto drawn = draw(folder, family.name, plot);
  std::vector<std::optional<double>> returns = family.equivalent_returns;
  for (auto& value : returns) {
    if (value) value = std::max(*value, 1.0);  // so that none at all has a place on the axis
  }
  const auto known = std::count_if(returns.begin(), returns.end(),
                                   [](const auto& value) { return value.has_value(); });
  if (!drawn || family.name != "severity" || known < 2) return drawn;
  LevelPlot over_truth = plot_of(family, returns);
  over_truth.level_label = "median equivalent returns along the weak axis, at least 1 [-]";
  over_truth.logarithmic_levels = true;
  sort_points(over_truth);
  return draw(folder, family.name + "-localizability", over_truth);
}

}  // namespace

Result<void> draw_families(const std::vector<FamilyResult>& families, const fs::path& folder,
                           const DrawObserver& observer) {
  std::error_code ignored;
  fs::create_directories(folder, ignored);
  for (const FamilyResult& family : families) {
    announce(observer, folder / (family.name + ".png"));
    if (auto drawn = draw_family(folder, family); !drawn) return drawn;
  }
  return {};
}

}  // namespace aims
