// SPDX-License-Identifier: BSD-3-Clause
#include "bench/run/score_table.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "bench/run/score_statistics.hpp"
#include "bench/run/validity.hpp"

namespace aims {
namespace {

struct Column {
  std::string title;
  std::string key;
  int digits;
};

std::vector<Column> columns_of(const RunRecord& run) {
  std::vector<Column> columns = {{"ATE yaw m", "ate_yaw_m", 3},
                                 {"ATE start m", "ate_m", 3},
                                 {"heading mrad", "heading_error_mrad", 1}};
  for (const Json& segment : run.scores.at("segments")) {
    const auto name = segment["name"].get<std::string>();
    columns.push_back({fmt::format("M_list({}) %", name), "m_list_percent." + name, 3});
  }
  columns.push_back({"M_end m", "m_end_m", 3});
  columns.push_back({"max |z| m", "max_error_z_m", 3});
  columns.push_back({"CPU ms/scan", "cpu_per_scan_ms.mean", 2});
  return columns;
}

std::string cell(const ScoreStatistics& summary, int digits, bool several) {
  if (!summary.median) return "-";
  const std::string median = fmt::format("{:.{}f}", *summary.median, digits);
  return several ? fmt::format("{} ({:.{}f})", median, *summary.worst, digits) : median;
}

std::string success_cell(std::span<const RunRecord> runs, const std::string& estimator,
                         const std::string& key) {
  if (std::ranges::none_of(runs, is_valid_run)) return "invalid run";
  const SuccessRate rate = success_rate(runs, estimator, key);
  if (runs.size() > 1) return rate.text();
  return rate.count == 1 ? "yes" : "no";
}

/// The row of a trajectory, whose scores have keys that begin with `prefix`.
std::vector<std::string> row_of(std::span<const RunRecord> runs, std::span<const Column> columns,
                                const std::string& estimator, const std::string& prefix) {
  std::vector<std::string> row = {prefix.empty() ? estimator : optimized_label(estimator)};
  for (const Column& column : columns) {
    const ScoreStatistics statistics = statistics_of(runs, estimator, prefix + column.key);
    row.push_back(cell(statistics, column.digits, runs.size() > 1));
  }
  for (const SuccessScore& score : kSuccessScores) {
    row.push_back(success_cell(runs, estimator, prefix + score.key));
  }
  return row;
}

}  // namespace

TextTable score_table(std::span<const RunRecord> runs) {
  TextTable table;
  if (runs.empty()) return table;
  // A route that was not finished may lack segments.
  const auto valid = std::ranges::find_if(runs, is_valid_run);
  const std::vector<Column> columns = columns_of(valid == runs.end() ? runs.front() : *valid);
  table.header = {"estimator"};
  for (const Column& column : columns) table.header.push_back(column.title);
  for (const SuccessScore& score : kSuccessScores) table.header.emplace_back(score.title);
  for (const auto& [estimator, unused] : runs.front().scores.at("estimators").items()) {
    table.rows.push_back(row_of(runs, columns, estimator, ""));
    const bool optimized = std::ranges::any_of(
        runs, [&, &name = estimator](const RunRecord& run) { return has_optimized(run, name); });
    if (optimized) table.rows.push_back(row_of(runs, columns, estimator, kOptimizedPrefix));
  }
  return table;
}

}  // namespace aims
