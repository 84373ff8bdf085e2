// SPDX-License-Identifier: BSD-3-Clause
#include "bench/scoring/score_table.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <utility>
#include <vector>

#include "bench/scoring/json_text.hpp"
#include "bench/scoring/score_statistics.hpp"
#include "bench/scoring/validity.hpp"
#include "core/text.hpp"

namespace aims {
namespace {

constexpr const char* kSe3Key = "ate_se3_m";

/// A column of `score`, at a key of numbers.
struct Column {
  std::string title;
  std::string key;
  Score score;
  bool optional = false;  ///< left out where no row has a value
};

/// An estimator's trajectory, whose scores have keys that begin with `prefix`.
struct Row {
  std::string estimator;
  std::string prefix;
};

/// More segments have a column for all of them alone.
constexpr std::size_t kMostSegments = 2;

Column column_of(const std::string& key, bool optional = false) {
  const Score& score = score_at(key);
  return {fmt::format("{} {}", score.title, score.unit), key, score, optional};
}

/// The M_list of one segment.
Column segment_column(const std::string& segment) {
  Column column = column_of("m_list_percent." + segment);
  column.title = fmt::format("{}({}) {}", column.score.title, segment, column.score.unit);
  return column;
}

/// Of several runs, whose cells are wide, those that a reader compares by.
std::vector<Column> columns_of(const RunRecord& run, bool several) {
  std::vector<Column> columns = {column_of("ate_yaw_m"), column_of("ate_m"),
                                 column_of("heading_error_mrad")};
  const Json segments = value_in(run.scores, "segments", Json::array());
  const bool shown = !several && segments.size() <= kMostSegments;
  for (const Json& segment : segments) {
    if (shown) columns.push_back(segment_column(segment["name"].get<std::string>()));
  }
  if (!shown || segments.size() != 1) columns.push_back(column_of("m_list_percent.all"));
  columns.push_back(column_of("m_end_m"));
  columns.push_back(column_of("control_points.score", true));
  if (!several) {
    columns.push_back(column_of(kSe3Key));
    columns.push_back(column_of("ate_sim3_m", true));
  }
  columns.push_back(column_of("path_error_percent.all", true));
  if (!several) columns.push_back(column_of("path_error_deg_per_m.all", true));
  columns.push_back(column_of("max_error_z_m"));
  columns.push_back(column_of("cpu_per_scan_ms.mean", true));
  columns.back().title += "/scan";
  return columns;
}

std::vector<Row> rows_of(std::span<const RunRecord> runs) {
  std::vector<Row> rows;
  for (const std::string& name : estimators_in(runs)) {
    rows.push_back({name, ""});
    const bool optimized =
        std::ranges::any_of(runs, [&](const RunRecord& run) { return has_optimized(run, name); });
    if (optimized) rows.push_back({name, kOptimizedPrefix});
  }
  return rows;
}

ScoreStatistics statistics_in(std::span<const RunRecord> runs, const Row& row,
                              const std::string& key) {
  return statistics_of(runs, row.estimator, row.prefix + key);
}

/// Whether its scores are of all that those of others are: every run, from start to end.
bool is_comparable(std::span<const RunRecord> runs, const Row& row) {
  return !any_partial(runs, row.estimator);
}

bool has_success(std::span<const RunRecord> runs, const Row& row) {
  return successes(runs, row.estimator, row.prefix + kSuccessKey) > 0;
}

/// The best median of the column among rows with a success; none of a single row.
std::optional<double> best_in(std::span<const RunRecord> runs, const std::vector<Row>& rows,
                              const Column& column) {
  if (rows.size() < 2 || is_timing(column.key)) return std::nullopt;
  const bool larger = column.score.better == Better::kLarger;
  std::optional<double> best;
  for (const Row& row : rows) {
    const auto median = statistics_in(runs, row, column.key).median;
    if (!median || !has_success(runs, row) || !is_comparable(runs, row)) continue;
    if (!best || (larger ? *median > *best : *median < *best)) best = median;
  }
  return best;
}

/// " line" or " point" where least squares left an angle open.
std::string spread_mark(const RunRecord& run, const Row& row) {
  const Json& scores = estimator_in(run, row.estimator);
  const std::string spread = value_in(value_in(scores, "alignment", Json()), "se3", "se3");
  if (spread != "se3") return " " + spread;
  return value_in(scores, "ate_se3_degenerate", false) ? " line" : "";
}

/// Marks of a cell, or those that stand anywhere in a table.
struct Marks {
  bool best = false;  ///< "*"
  bool lost = false;  ///< " x": a median over runs without success
  bool part = false;  ///< " part"

  void add(const Marks& others) {
    best = best || others.best;
    lost = lost || others.lost;
    part = part || others.part;
  }
};

/// The marks of a cell that has the median `median`.
Marks marks_of(std::span<const RunRecord> runs, const Row& row, const Column& column, double median,
               const std::optional<double>& best) {
  if (is_timing(column.key)) return {};
  const bool success = has_success(runs, row);
  const bool whole = is_comparable(runs, row);
  return {.best = success && whole && best && median == *best,
          .lost = runs.size() > 1 && !success,
          .part = !whole};
}

/// The text of a cell, whose marks are added to `marks`.
std::string cell(std::span<const RunRecord> runs, const Row& row, const Column& column,
                 const std::optional<double>& best, Marks& marks) {
  const ScoreStatistics summary = statistics_in(runs, row, column.key);
  if (!summary.median) return "-";
  const Marks own = marks_of(runs, row, column, *summary.median, best);
  marks.add(own);
  std::string text = decimal_text(*summary.median, column.score.digits);
  if (runs.size() > 1)
    text += fmt::format(" ({})", decimal_text(*summary.worst, column.score.digits));
  if (own.best) text += "*";
  if (own.lost) text += " x";
  text += part_mark(own.part);
  if (runs.size() == 1 && column.key == kSe3Key) text += spread_mark(runs.front(), row);
  return text;
}

/// "yes", or why and when it diverged [s after the truth's start].
std::string outcome_of(const RunRecord& run, const Row& row) {
  const Json& scores = estimator_in(run, row.estimator);
  const Json own = row.prefix.empty() ? scores : value_in(scores, "optimized", Json());
  if (value_in(own, "success", false)) return "yes";
  if (member(own, "success").is_null()) return "-";  // of a truth that says nothing of the way
  const std::string reason = value_in(own, "diverged_reason", "no");
  const auto at = number_at(own, "diverged_at_s");
  if (!at || reason == "starts_late") return reason.empty() ? "no" : reason;
  const double start = value_in(value_in(run.scores, "truth", Json()), "start_s", 0.0);
  return fmt::format("{} at {:.1f} s", reason.empty() ? "diverged" : reason, *at - start);
}

std::string success_cell(std::span<const RunRecord> runs, const Row& row, const Score& score) {
  const auto valid = static_cast<std::size_t>(std::ranges::count_if(runs, is_valid_run));
  if (valid == 0) return "invalid run";
  if (failed_runs(runs, row.estimator) == valid) {
    return runs.size() == 1 ? "failed" : fmt::format("failed ({0} of {0} seeds)", valid);
  }
  if (runs.size() == 1 && std::string(score.key) == kSuccessKey) {
    return outcome_of(runs.front(), row);
  }
  const SuccessRate rate = success_rate(runs, row.estimator, row.prefix + score.key);
  const std::size_t failed = failed_runs(runs, row.estimator);
  if (failed > 0) return fmt::format("{}, {} failed", rate.text(), failed);
  if (runs.size() > 1 || rate.runs == 0) return rate.text();
  return rate.count == 1 ? "yes" : "no";
}

/// Least fraction of the truth's time that was tracked.
std::string tracked_cell(std::span<const RunRecord> runs, const Row& row) {
  std::optional<double> least;
  for (const RunRecord& run : runs) {
    if (!is_valid_run(run)) continue;
    const auto value = find_score(run, row.estimator, row.prefix + "coverage");
    if (value) least = std::min(*value, least.value_or(*value));
  }
  return least ? fmt::format("{:.0f} %", 100.0 * *least) : "-";
}

/// The table, and the marks that stand in it.
std::pair<TextTable, Marks> marked_table(std::span<const RunRecord> runs) {
  TextTable table;
  Marks marks;
  if (runs.empty()) return {table, marks};
  const std::vector<Row> rows = rows_of(runs);
  const RunRecord* example = example_run(runs);
  std::vector<Column> columns =
      columns_of(example == nullptr ? runs.front() : *example, runs.size() > 1);
  std::erase_if(columns, [&](const Column& column) {
    return column.optional && std::ranges::none_of(rows, [&](const Row& row) {
             return statistics_in(runs, row, column.key).median.has_value();
           });
  });
  table.header = {"estimator"};
  for (const Column& column : columns) table.header.push_back(column.title);
  table.header.emplace_back("tracked");
  for (const Score& score : success_scores()) table.header.emplace_back(score.title);
  for (const Row& row : rows) {
    table.rows.push_back({row.prefix.empty() ? row.estimator : optimized_label(row.estimator)});
    for (const Column& column : columns) {
      table.rows.back().push_back(cell(runs, row, column, best_in(runs, rows, column), marks));
    }
    table.rows.back().push_back(tracked_cell(runs, row));
    for (const Score& score : success_scores()) {
      table.rows.back().push_back(success_cell(runs, row, score));
    }
  }
  return {table, marks};
}

}  // namespace

TextTable score_table(std::span<const RunRecord> runs) { return marked_table(runs).first; }

std::string score_legend(std::span<const RunRecord> runs, const ScoreConfig& scoring) {
  return legend_of_tables({runs}, scoring);
}

std::string legend_of_tables(const std::vector<std::span<const RunRecord>>& tables,
                             const ScoreConfig& scoring) {
  const char* start = scoring.truth == TruthContent::kPosition
                          ? "the first position, the rotation by least squares over the path"
                      : scoring.anchor == AlignmentKind::kStartPose
                          ? "the standing start, by position and rotation"
                          : "the first pose, by position and heading";
  Marks marks;
  for (const auto& runs : tables) marks.add(marked_table(runs).second);
  const bool several =
      std::ranges::any_of(tables, [](const auto& runs) { return runs.size() > 1; });
  std::string text = fmt::format(
      "ATE yaw, heading: after least squares over all positions, by translation and heading.\n"
      "ATE start, M_end, max |z|: aligned to the truth at {}.\n"
      "{}path error: mean over pieces of 5 to 100 m (KITTI). within 5 %, 1 %: position error of\n"
      "the distance travelled so far. tracked: of the truth's time, poses at most {:g} s "
      "apart{}.\n",
      start,
      several ? "" : "ATE SE(3): least squares by translation and rotation (Umeyama, as evo).\n",
      scoring.max_gap, several ? ", the least of the seeds" : "");
  const ScoreConfig usual;
  if (scoring.max_error_offset != usual.max_error_offset ||
      scoring.max_error_per_path != usual.max_error_per_path) {
    text += fmt::format(
        "\"within 5 %\" is here within the larger of {:g} m and {:g} % of the distance, as set.\n",
        scoring.max_error_offset, 100.0 * scoring.max_error_per_path);
  }
  if (several) {
    text +=
        "Cells: median over seeds (worst). Success: runs, with the 95 % interval of the rate.\n";
  }
  if (marks.lost) text += "x: a median over runs of which none succeeded.\n";
  if (marks.best) text += "A star: best of those with a success whose estimates cover every run.\n";
  if (marks.part) text += kPartLegend;
  return text;
}

}  // namespace aims
