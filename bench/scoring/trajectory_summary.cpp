// SPDX-License-Identifier: BSD-3-Clause
#include "bench/scoring/trajectory_summary.hpp"

#include <fmt/format.h>

#include <string_view>
#include <utility>

#include "bench/scoring/json_text.hpp"
#include "bench/scoring/report.hpp"
#include "bench/scoring/score_table.hpp"
#include "bench/scoring/tables.hpp"

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

/// What the alignment at the start is by.
std::string_view name_of(AlignmentKind start) {
  switch (start) {
    case AlignmentKind::kStartPose:
      return "pose";
    case AlignmentKind::kStartYaw:
      return "path";
    case AlignmentKind::kStartSe3:
      return "path_se3";
    default:
      return "heading";
  }
}

Json estimate_json(const ScoredEstimate& estimate, const ScoreConfig& scoring) {
  const Scores& scores = estimate.scores;
  Json json = scores_json(scores);
  json["poses"] = scores.poses;
  json["poses_invalid"] = scores.poses_invalid;
  json["poses_compared"] = scores.poses_compared;
  json["median_stamp_difference_s"] = json_of(estimate.median_stamp_difference_s);
  json["alignment"] = {{"start", name_of(start_alignment(scoring))},
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
  return score_table({&record, 1});
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
  const RunRecord record = record_of(scores);
  return score_legend({&record, 1}, scores.scoring);
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
                     {"path_m", path_length(truth)},
                     {"attitude", scores.scoring.truth != TruthContent::kPosition}}},
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
  return write_report({.name = "scores",
                       .markdown = markdown(scores),
                       .csv = scores_csv({&record, 1}),
                       .json = record.scores,
                       .latex = to_latex(trajectory_score_table(scores))},
                      folder);
}

}  // namespace aims
