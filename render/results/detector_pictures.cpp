// SPDX-License-Identifier: BSD-3-Clause
#include "render/results/detector_pictures.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "bench/metrics/localizability_scores.hpp"
#include "render/plots/roc_plot.hpp"

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

}  // namespace aims
