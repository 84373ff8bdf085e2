// SPDX-License-Identifier: BSD-3-Clause
#include "render/results/study_pictures.hpp"

#include <fmt/format.h>
#include <algorithm>
#include <cmath>
#include <optional>
#include <system_error>

#include "bench/metrics/localizability_scores.hpp"
#include "bench/studies/written_runs.hpp"
#include "render/plots/level_plot.hpp"
#include "render/plots/roc_plot.hpp"
#include "render/plots/time_plot.hpp"
#include "render/results/run_pictures.hpp"

namespace aims {

namespace {

bool is_pooled(const DetectorScore& score) { return score.scenario.empty(); }

RocPlot roc_plot(const DetectorStudy& study) {
  RocPlot plot;
  plot.title = fmt::format("Indices of {} as detectors of degeneracy", study.estimator);
  const auto pooled = std::find_if(study.scores.begin(), study.scores.end(), is_pooled);
  plot.subtitle = fmt::format("{} runs, {} scans; AUC in brackets; dotted = chance",
                              study.runs.size(), pooled == study.scores.end() ? 0 : pooled->scans);
  for (const DegeneracyLevel& level : kDegeneracyLevels) {
    RocPanel& panel = plot.panels.emplace_back();
    panel.title = fmt::format("fewer than {:.0f} equivalent returns", level.equivalent_returns);
    for (const DetectorScore& score : study.scores) {
      if (!is_pooled(score) || score.level != level.name || score.curve.empty()) continue;
      RocSeries& series = panel.series.emplace_back();
      series.name = fmt::format("{} ({:.2f})", score.index, *score.auc);
      for (const RocPoint& point : score.curve) {
        series.points.emplace_back(point.false_positive_rate, point.true_positive_rate);
      }
    }
  }
  return plot;
}

}  // namespace

Result<void> draw_detectors(const DetectorStudy& study, const std::filesystem::path& folder) {
  const RocPlot plot = roc_plot(study);
  for (const char* name : {"roc.png", "roc.svg"}) {
    if (auto drawn = write_roc_plot(folder / name, plot); !drawn) return drawn;
  }
  return {};
}

namespace {

namespace fs = std::filesystem;

TimePanel nees_panel(const Consistency& result) {
  TimePanel panel{"Mean NEES over seeds, and the 95 % bounds of a consistent filter",
                  "NEES [-]",
                  {{"mean over seeds", {}}, {"lower bound", {}}, {"upper bound", {}}},
                  true,
                  false};
  for (const ConsistencyInstant& at : result.instants) {
    if (!at.nees) continue;
    panel.series[0].points.emplace_back(at.time_s, *at.nees);
    panel.series[1].points.emplace_back(at.time_s, *at.bounds.low);
    panel.series[2].points.emplace_back(at.time_s, *at.bounds.high);
  }
  return panel;
}

TimePanel spread_panel(const Consistency& result) {
  TimePanel panel{"Root mean squares over seeds",
                  "error along the weak axis [m]",
                  {{"error", {}}, {"stated deviation", {}}, {"bound", {}}, {"bound of legs", {}}},
                  true,
                  false};
  for (const ConsistencyInstant& at : result.instants) {
    const double values[] = {at.error_rms_m, at.sigma_rms_m, at.bound_rms_m, at.leg_bound_rms_m};
    for (std::size_t i = 0; i < 4; ++i) {
      if (values[i] > 0.0) panel.series[i].points.emplace_back(at.time_s, values[i]);
    }
  }
  return panel;
}

/// One run: its error against twice what it states.
TimePanel run_panel(const ConsistencyCase& each, std::size_t run) {
  TimePanel panel{fmt::format("Seed {}", each.seeds[run]),
                  "error along the weak axis [m]",
                  {{"size of the error", {}}, {"2 sigma", {}}},
                  false,
                  true};
  for (const ConsistencySample& sample : each.runs[run]) {
    panel.series[0].points.emplace_back(sample.time_s, std::abs(sample.error_m));
    if (sample.sigma_m) panel.series[1].points.emplace_back(sample.time_s, 2.0 * *sample.sigma_m);
  }
  return panel;
}

Result<void> draw(const ConsistencyCase& each, const fs::path& folder) {
  if (each.result.runs == 0) return {};
  TimePlot plot;
  plot.title =
      fmt::format("{}: consistency of {} along the weak axis", each.scenario, each.estimator);
  plot.subtitle = fmt::format(
      "{} seeds; NEES inside its bounds at {} % of {} instants", each.result.runs,
      each.result.inside_fraction ? fmt::format("{:.0f}", 100.0 * *each.result.inside_fraction)
                                  : "-",
      each.result.judged);
  plot.panels = {nees_panel(each.result), spread_panel(each.result)};
  for (std::size_t i = 0; i < each.runs.size(); ++i) {
    if (each.runs[i].empty()) continue;
    plot.panels.push_back(run_panel(each, i));
    break;
  }
  const std::string name = fmt::format("{}-{}-consistency", each.scenario, each.estimator);
  for (const char* ending : {".png", ".svg"}) {
    if (auto drawn = write_time_plot(folder / (name + ending), plot); !drawn) return drawn;
  }
  return {};
}

}  // namespace

Result<void> draw_consistency(const ConsistencyStudy& study, const fs::path& folder) {
  for (const ConsistencyCase& each : study) {
    if (auto drawn = draw(each, folder); !drawn) return drawn;
  }
  return {};
}

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

Result<void> draw_paper(const std::vector<PaperExperiment>& experiments,
                        const std::filesystem::path& folder, const DrawObserver& observer) {
  for (const PaperExperiment& each : experiments) {
    if (each.seeds.empty()) continue;
    auto drawn = draw_systems(suite_run_folder(folder, each.scenario, each.seeds.front()),
                              {"loam", "fast_lio2", "lego_loam", "aims"}, folder, observer);
    if (!drawn) return drawn;
  }
  return {};
}

}  // namespace aims
