// SPDX-License-Identifier: BSD-3-Clause
#include "bench/run/trajectory_summary.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <string_view>
#include <utility>

#include "bench/run/json_text.hpp"
#include "bench/run/tables.hpp"
#include "core/files/atomic_file.hpp"

namespace aims {
namespace {

namespace fs = std::filesystem;

/// What least squares determined of the rotation.
std::string_view name_of(PositionSpread spread) {
  switch (spread) {
    case PositionSpread::kFull:
      break;
    case PositionSpread::kLine:
      return "line";
    case PositionSpread::kPoint:
      return "point";
  }
  return "se3";
}

struct ScoreColumn {
  std::string title;
  std::string key;  ///< of the record; the smaller its value the better
  int digits = 3;
};

std::vector<ScoreColumn> score_columns(const RunRecord& record, bool scored_with_scale) {
  std::vector<ScoreColumn> columns = {{"ATE yaw m", "ate_yaw_m"},
                                      {"ATE start m", "ate_m"},
                                      {"heading mrad", "heading_error_mrad", 1}};
  for (const Json& segment : record.scores["segments"]) {
    const auto name = segment["name"].get<std::string>();
    columns.push_back({fmt::format("M_list({}) %", name), "m_list_percent." + name});
  }
  if (columns.size() != 1) columns.push_back({"M_list %", "m_list_percent.all"});
  columns.push_back({"M_end m", "m_end_m"});
  columns.push_back({"ATE SE(3) m", "ate_se3_m"});
  if (scored_with_scale) columns.push_back({"ATE Sim(3) m", "ate_sim3_m"});
  columns.push_back({"RPE %", "path_error_percent.all"});
  columns.push_back({"RPE deg/m", "path_error_deg_per_m.all"});
  columns.push_back({"max |z| m", "max_error_z_m"});
  return columns;
}

/// The smallest value of the column among estimates that did not diverge; none of a single
/// estimate.
std::optional<double> best(const TrajectoryScores& scores, const RunRecord& record,
                           const ScoreColumn& column) {
  if (scores.estimates.size() < 2) return std::nullopt;
  std::optional<double> smallest;
  for (const ScoredEstimate& each : scores.estimates) {
    const auto value = find_score(record, each.given.name, column.key);
    if (each.scores.success && value) smallest = std::min(*value, smallest.value_or(*value));
  }
  return smallest;
}

std::string cell(const ScoredEstimate& estimate, const RunRecord& record, const ScoreColumn& column,
                 const std::optional<double>& smallest) {
  const auto value = find_score(record, estimate.given.name, column.key);
  if (!value) return "-";
  const bool is_best = estimate.scores.success && smallest && *value == *smallest;
  const bool marked =
      column.key == "ate_se3_m" && estimate.scores.se3_spread != PositionSpread::kFull;
  return fmt::format("{:.{}f}{}{}", *value, column.digits, is_best ? "*" : "",
                     marked ? fmt::format(" {}", name_of(estimate.scores.se3_spread)) : "");
}

/// "yes", or why and when it diverged [s after the truth's start].
std::string success_cell(const Scores& scores, const Trajectory& truth) {
  if (scores.success) return "yes";
  if (!scores.diverged_at) return std::string(name_of(scores.failure_reason));
  return fmt::format("{} at {:.1f} s", name_of(scores.failure_reason),
                     to_seconds(*scores.diverged_at - truth.front().stamp));
}

Json estimate_json(const ScoredEstimate& estimate, const ScoreConfig& scoring) {
  const Scores& scores = estimate.scores;
  Json json = scores_json(scores);
  json["poses"] = scores.poses;
  json["poses_invalid"] = scores.poses_invalid;
  json["poses_compared"] = scores.poses_compared;
  json["median_stamp_difference_s"] = json_of(estimate.median_stamp_difference_s);
  json["alignment"] = {{"start", scoring.anchor == AlignmentKind::kStartPose ? "pose" : "heading"},
                       {"se3", name_of(scores.se3_spread)}};
  json["source"] = estimate.given.source;
  json["kind"] = estimate.given.kind;
  return json;
}

std::string markdown(const TrajectoryScores& scores) {
  std::string text =
      fmt::format("# Scores against {}\n\n{}\n{}\n{}\n", scores.truth.name,
                  to_markdown(trajectory_score_table(scores)),
                  to_markdown(trajectory_source_table(scores)), score_legend(scores));
  for (const std::string& note : scores.notes) text += fmt::format("- {}\n", note);
  return text;
}

}  // namespace

TextTable trajectory_score_table(const TrajectoryScores& scores) {
  const RunRecord record = record_of(scores);
  const std::vector<ScoreColumn> columns = score_columns(record, scores.scoring.sim3);
  TextTable table;
  table.header = {"estimate"};
  for (const ScoreColumn& column : columns) table.header.push_back(column.title);
  table.header.emplace_back("tracked");
  table.header.emplace_back("within 5 %");
  table.header.emplace_back("within 1 %");
  for (const ScoredEstimate& each : scores.estimates) {
    std::vector<std::string> row = {each.given.name};
    for (const ScoreColumn& column : columns) {
      row.push_back(cell(each, record, column, best(scores, record, column)));
    }
    row.push_back(fmt::format("{:.0f} %", 100.0 * each.scores.coverage));
    row.push_back(success_cell(each.scores, scores.truth.trajectory));
    row.emplace_back(each.scores.success_1_percent ? "yes" : "no");
    table.rows.push_back(std::move(row));
  }
  return table;
}

TextTable trajectory_source_table(const TrajectoryScores& scores) {
  TextTable table;
  table.header = {"trajectory", "poses", "matched", "stamps off by ms", "kind", "source"};
  table.rows.push_back({"truth", std::to_string(scores.truth.trajectory.size()), "", "",
                        scores.truth.kind, scores.truth.source});
  for (const ScoredEstimate& each : scores.estimates) {
    const auto& difference = each.median_stamp_difference_s;
    table.rows.push_back({each.given.name, std::to_string(each.scores.poses),
                          std::to_string(each.scores.poses_compared),
                          difference ? fmt::format("{:.3f}", 1e3 * *difference) : "-",
                          each.given.kind, each.given.source});
  }
  return table;
}

std::string score_legend(const TrajectoryScores& scores) {
  const bool pose = scores.scoring.anchor == AlignmentKind::kStartPose;
  std::string text = fmt::format(
      "ATE yaw, heading: after least squares over all positions, by translation and heading.\n"
      "ATE start, M_end, max |z|: aligned to the truth at {}.\n"
      "ATE SE(3): least squares by translation and rotation (Umeyama, as evo). RPE: mean over "
      "pieces\n"
      "of 5 to 100 m (KITTI). within 5 %, 1 %: position error of the distance travelled so far.\n"
      "tracked: of the truth's time, with poses at most {:g} s apart.\n",
      pose ? "the standing start, by position and rotation"
           : "the first pose, by position and heading",
      scores.scoring.max_gap);
  if (scores.estimates.size() > 1) text += "A star: smallest of those that did not diverge.\n";
  return text;
}

RunRecord record_of(const TrajectoryScores& scores) {
  RunRecord record;
  const Trajectory& truth = scores.truth.trajectory;
  record.scores = {{"schema", kScoresSchema},
                   {"version", AIMS_VERSION},
                   {"scenario", scores.truth.name},
                   {"seed", record.seed},
                   {"complete", true},
                   {"truth",
                    {{"source", scores.truth.source},
                     {"kind", scores.truth.kind},
                     {"poses", truth.size()},
                     {"start_s", to_seconds(truth.front().stamp)},
                     {"end_s", to_seconds(truth.back().stamp)},
                     {"path_m", path_length(truth)}}},
                   {"notes", scores.notes},
                   {"segments", Json::array()},
                   {"estimators", Json::object()},
                   {"expectations", Json::array()}};
  if (!scores.estimates.empty()) {
    record.scores["segments"] = segments_json(scores.estimates.front().scores);
  }
  for (const ScoredEstimate& each : scores.estimates) {
    record.scores["estimators"][each.given.name] = estimate_json(each, scores.scoring);
  }
  return record;
}

Result<void> write_trajectory_scores(const TrajectoryScores& scores, const fs::path& folder) {
  const RunRecord record = record_of(scores);
  auto written = write_file_atomically(folder / "scores.json", json_text(record.scores, 2) + "\n");
  if (written) written = write_csv(folder / "scores.csv", scores_csv({&record, 1}));
  if (written) written = write_file_atomically(folder / "scores.md", markdown(scores));
  if (written) {
    written =
        write_file_atomically(folder / "scores.tex", to_latex(trajectory_score_table(scores)));
  }
  return written;
}

}  // namespace aims
