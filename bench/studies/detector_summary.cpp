// SPDX-License-Identifier: BSD-3-Clause
#include "bench/studies/detector_summary.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "bench/scoring/json_text.hpp"
#include "bench/scoring/report.hpp"
#include "core/files/csv.hpp"

namespace aims {
namespace {

namespace fs = std::filesystem;

constexpr const char* kDetectorsIntroduction =
    "# Indices of `{}` as detectors of degeneracy\n"
    "\n"
    "A scan is degenerate at nK when its true returns constrain its weakest axis less than K\n"
    "returns of a facing surface would. AUC with 95 % interval (bootstrap over runs); detected =\n"
    "fraction of degenerate scans at {:.0f} % false alarms; delay = median from onset to alarm "
    "over\n"
    "the onsets that were detected; missed = onsets without an alarm. AUC 0.5 is no better than\n"
    "random; below it the index has the wrong sign. Alarms at random on 5 % of the scans of 10 Hz\n"
    "would come 1.4 s after an onset in the median. Pooling over scenarios also rewards an index\n"
    "that differs between scenarios; the tables of single scenarios do not.\n";

Json score_json(const DetectorScore& score) {
  Json curve = Json::array();
  for (const RocPoint& point : score.curve) {
    curve.push_back({point.false_positive_rate, point.true_positive_rate});
  }
  return {{"scenario", score.scenario.empty() ? Json() : Json(score.scenario)},
          {"level", score.level},
          {"index", score.index},
          {"runs", score.runs},
          {"scans", score.scans},
          {"degenerate", score.degenerate},
          {"auc", json_of(score.auc)},
          {"auc_low", json_of(score.auc_interval.low)},
          {"auc_high", json_of(score.auc_interval.high)},
          {"threshold", json_of(score.threshold)},
          {"detections", json_of(score.detections)},
          {"onsets", score.onsets},
          {"missed", score.missed},
          {"median_delay_s", json_of(score.median_delay_s)},
          {"curve", std::move(curve)}};
}

Json study_json(const DetectorStudy& study) {
  Json levels = Json::object();
  for (const DegeneracyLevel& level : kDegeneracyLevels) {
    levels[std::string(level.name)] = level.equivalent_returns;
  }
  Json indices = Json::object();
  for (const DegeneracyIndex& index : degeneracy_indices()) {
    const bool judged = std::ranges::count(study.scores, index.name, &DetectorScore::index) > 0;
    if (!judged) continue;
    indices[index.name] = {{"degenerate_when", index.high_is_degenerate ? "high" : "low"},
                           {"source", index.source}};
  }
  Json runs = Json::array();
  for (const DetectorRun& run : study.runs) {
    runs.push_back({{"scenario", run.scenario},
                    {"seed", run.seed},
                    {"scans", run.scans.size()},
                    {"without_update", run.without_update},
                    {"without_truth", run.without_truth}});
  }
  Json scores = Json::array();
  for (const DetectorScore& score : study.scores) scores.push_back(score_json(score));
  return {{"schema", "aims.detectors/2"},  {"estimator", study.estimator},
          {"false_alarms", kFalseAlarms},  {"equivalent_returns_below", std::move(levels)},
          {"indices", std::move(indices)}, {"runs", std::move(runs)},
          {"scores", std::move(scores)},   {"warnings", study.warnings}};
}

CsvTable study_csv(const DetectorStudy& study) {
  CsvTable table({"scenario", "level", "index", "runs", "scans", "degenerate", "auc", "auc_low",
                  "auc_high", "threshold", "detections", "onsets", "missed", "median_delay_s"});
  for (const DetectorScore& s : study.scores) {
    table.add(s.scenario).add(s.level).add(s.index).add(s.runs).add(s.scans).add(s.degenerate);
    table.add(s.auc).add(s.auc_interval.low).add(s.auc_interval.high).add(s.threshold);
    table.add(s.detections).add(s.onsets).add(s.missed).add(s.median_delay_s).end_row();
  }
  return table;
}

std::string auc_text(const DetectorScore& score) {
  if (!score.auc) return "–";
  if (!score.auc_interval.low) return fmt::format("{:.3f}", *score.auc);
  return fmt::format("{:.3f} [{:.3f}, {:.3f}]", *score.auc, *score.auc_interval.low,
                     *score.auc_interval.high);
}

/// The scores of one set of runs; an empty name is the pooled set.
std::vector<DetectorScore> scores_of(std::span<const DetectorScore> scores,
                                     const std::string& scenario) {
  std::vector<DetectorScore> result;
  for (const DetectorScore& score : scores) {
    if (score.scenario == scenario) result.push_back(score);
  }
  return result;
}

TextTable table_of(std::span<const DetectorScore> scores) {
  TextTable table;
  table.header = {"index"};
  for (const DegeneracyLevel& level : kDegeneracyLevels) {
    const std::string name(level.name);
    for (const char* column : {"AUC", "detected", "delay s", "missed"}) {
      table.header.push_back(name + " " + column);
    }
  }
  for (const DegeneracyIndex& index : degeneracy_indices()) {
    std::vector<std::string> row = {index.name};
    for (const DetectorScore& score : scores) {
      if (score.index != index.name) continue;
      row.push_back(auc_text(score));
      row.push_back(score.detections ? fmt::format("{:.2f}", *score.detections) : "–");
      row.push_back(score.median_delay_s ? fmt::format("{:.1f}", *score.median_delay_s) : "–");
      row.push_back(score.auc ? fmt::format("{}/{}", score.missed, score.onsets) : "–");
    }
    if (row.size() > 1) table.rows.push_back(std::move(row));
  }
  return table;
}

std::vector<std::string> scenarios_of(std::span<const DetectorScore> scores) {
  std::vector<std::string> names;
  for (const DetectorScore& score : scores) {
    const bool known = std::find(names.begin(), names.end(), score.scenario) != names.end();
    if (!known) names.push_back(score.scenario);
  }
  return names;
}

std::string study_markdown(const DetectorStudy& study) {
  std::string text = fmt::format(kDetectorsIntroduction, study.estimator, 100.0 * kFalseAlarms);
  for (const std::string& scenario : scenarios_of(study.scores)) {
    const auto scores = scores_of(study.scores, scenario);
    text += fmt::format("\n## {}\n\n", scenario.empty() ? "All runs pooled" : scenario);
    if (!scores.empty()) {
      text += fmt::format("{} runs, {} scans; degenerate:", scores[0].runs, scores[0].scans);
      for (const DegeneracyLevel& level : kDegeneracyLevels) {
        const auto found = std::find_if(scores.begin(), scores.end(), [&](const auto& score) {
          return score.level == level.name;
        });
        text += fmt::format(" {} {}", level.name, found->degenerate);
      }
      text += "\n\n";
    }
    text += to_markdown(table_of(scores));
  }
  for (const std::string& warning : study.warnings) text += "\n" + warning + "\n";
  return text;
}

}  // namespace

TextTable detector_table(std::span<const DetectorScore> scores) {
  return table_of(scores_of(scores, ""));
}

std::vector<std::string> undecided_levels(std::span<const DetectorScore> scores) {
  std::vector<std::string> lines;
  std::set<std::pair<std::string, std::string>> seen;
  for (const DetectorScore& score : scores) {
    if (score.auc || !seen.insert({score.scenario, score.level}).second) continue;
    lines.push_back(
        fmt::format("{}, {}: {} of {} scans are degenerate, so that nothing can be detected",
                    score.scenario.empty() ? "all runs" : score.scenario, score.level,
                    score.degenerate == 0 ? "none" : "all", score.scans));
  }
  return lines;
}

Result<void> write_detectors(const DetectorStudy& study, const fs::path& folder) {
  return write_report({.name = "detectors",
                       .markdown = study_markdown(study),
                       .csv = study_csv(study),
                       .json = study_json(study)},
                      folder);
}

}  // namespace aims
