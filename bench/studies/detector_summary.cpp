// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "bench/scoring/report.hpp"
#include "bench/studies/detectors.hpp"

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

const TableColumns<DetectorScore>& score_columns() {
  using Detector = DetectorScore;
  static const TableColumns<Detector> columns = {
      {"scenario", "",
       [](const Detector& d) { return d.scenario.empty() ? Json() : Json(d.scenario); }},
      {"level", "", &Detector::level},
      {"index", "", &Detector::index},
      {"runs", "", &Detector::runs},
      {"scans", "", &Detector::scans},
      {"degenerate", "", &Detector::degenerate},
      {"auc", "", &Detector::auc},
      {"auc_low", "", [](const Detector& d) { return d.auc_interval.low; }},
      {"auc_high", "", [](const Detector& d) { return d.auc_interval.high; }},
      {"threshold", "", &Detector::threshold},
      {"detections", "", &Detector::detections},
      {"onsets", "", &Detector::onsets},
      {"missed", "", &Detector::missed},
      {"median_delay_s", "", &Detector::median_delay_s}};
  return columns;
}

Json score_json(const DetectorScore& score) {
  Json json = row_json(score_columns(), score);
  json["curve"] = json_array(score.curve, [](const RocPoint& point) {
    return std::array{point.false_positive_rate, point.true_positive_rate};
  });
  return json;
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
  Json runs = json_array(study.runs, [](const DetectorRun& run) {
    return Json{{"scenario", run.scenario},
                {"seed", run.seed},
                {"scans", run.scans.size()},
                {"without_update", run.without_update},
                {"without_truth", run.without_truth}};
  });
  return {{"schema", "aims.detectors/2"},
          {"estimator", study.estimator},
          {"false_alarms", kFalseAlarms},
          {"equivalent_returns_below", std::move(levels)},
          {"indices", std::move(indices)},
          {"runs", std::move(runs)},
          {"scores", json_array(study.scores, score_json)},
          {"warnings", study.warnings}};
}

std::string auc_text(const DetectorScore& score) {
  std::string text = number_text(score.auc, "{:.3f}", "–");
  if (score.auc_interval.low) text += " " + interval_text(score.auc_interval, "{:.3f}");
  return text;
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
      row.push_back(number_text(score.detections, "{:.2f}", "–"));
      row.push_back(number_text(score.median_delay_s, "{:.1f}", "–"));
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
                       .csv = rows_csv(score_columns(), study.scores),
                       .json = study_json(study)},
                      folder);
}

}  // namespace aims
