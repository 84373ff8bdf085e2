// SPDX-License-Identifier: BSD-3-Clause
#include "bench/scoring/tables.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <limits>
#include <map>
#include <optional>
#include <string>

#include "bench/scoring/validity.hpp"
#include "core/files/csv_columns.hpp"

namespace aims {
namespace {

constexpr const char* kStamp = "stamp_s";
constexpr const char* kTime = "time_ms";

/// Columns of a covariance: the upper triangle, row by row.
std::vector<std::string> covariance_columns(const std::string& name) {
  std::vector<std::string> columns;
  for (const char* axes : {"_xx", "_xy", "_xz", "_yy", "_yz", "_zz"})
    columns.push_back(name + axes);
  return columns;
}

const std::vector<std::string> kPositionColumns = covariance_columns("position_covariance");
const std::vector<std::string> kRotationColumns = covariance_columns("rotation_covariance");

std::vector<std::string> diagnostics_header(std::span<const SeriesInfo> series) {
  std::vector<std::string> header = {kStamp};
  for (const SeriesInfo& info : series) header.push_back(info.name);
  header.insert(header.end(), kPositionColumns.begin(), kPositionColumns.end());
  header.insert(header.end(), kRotationColumns.begin(), kRotationColumns.end());
  header.emplace_back(kTime);
  return header;
}

void add_symmetric(const Eigen::Matrix3d& matrix, CsvTable& table) {
  for (int row = 0; row < 3; ++row) {
    for (int column = row; column < 3; ++column) table.add(matrix(row, column));
  }
}

void add_covariance(const std::optional<PoseCovariance>& covariance, CsvTable& table) {
  const auto none = Eigen::Matrix3d::Constant(std::numeric_limits<double>::quiet_NaN());
  add_symmetric(covariance ? covariance->position : none, table);
  add_symmetric(covariance ? covariance->rotation : none, table);
}

/// Columns of a diagnostics file by name.
using Columns = std::map<std::string, std::vector<double>>;

/// The covariance in row `row`; none where a column is missing or a cell is empty.
std::optional<Eigen::Matrix3d> symmetric_at(const Columns& columns,
                                            const std::vector<std::string>& names,
                                            std::size_t row) {
  Eigen::Matrix3d matrix;
  auto name = names.begin();
  for (int i = 0; i < 3; ++i) {
    for (int j = i; j < 3; ++j) {
      const auto column = columns.find(*name++);
      if (column == columns.end()) return std::nullopt;
      matrix(i, j) = matrix(j, i) = column->second[row];
    }
  }
  return matrix.allFinite() ? std::optional(matrix) : std::nullopt;
}

std::optional<PoseCovariance> covariance_at(const Columns& columns, std::size_t row) {
  const auto position = symmetric_at(columns, kPositionColumns, row);
  const auto rotation = symmetric_at(columns, kRotationColumns, row);
  if (!position || !rotation) return std::nullopt;
  return PoseCovariance{*position, *rotation};
}

/// The columns that are neither stamp, nor time, nor covariance.
std::vector<SeriesInfo> series_in(const std::vector<std::string>& header) {
  std::vector<SeriesInfo> series;
  for (const std::string& name : header) {
    const bool other = name == kStamp || name == kTime ||
                       std::ranges::count(kPositionColumns, name) > 0 ||
                       std::ranges::count(kRotationColumns, name) > 0;
    if (!other) series.push_back({name, "", ""});
  }
  return series;
}

Result<Columns> columns_of(const CsvColumns& table) {
  Columns columns;
  for (const std::string& name : table.header()) {
    auto numbers = table.numbers(name);
    if (!numbers) return tl::unexpected(numbers.error());
    columns[name] = std::move(*numbers);
  }
  return columns;
}

}  // namespace

CsvTable diagnostics_table(const EstimatorRows& rows) {
  CsvTable table(diagnostics_header(rows.series));
  add_scans(rows, table);
  return table;
}

void add_scans(const EstimatorRows& rows, CsvTable& table) {
  for (std::size_t i = 0; i < rows.scans.size(); ++i) {
    const ScanRow& scan = rows.scans[i];
    assert(scan.values.size() == rows.series.size());
    table.add(to_seconds(scan.stamp));
    for (const double value : scan.values) table.add(value);
    add_covariance(scan.covariance, table);
    if (i < rows.wall_ms.size()) table.add(rows.wall_ms[i]);
    table.end_row();
  }
}

Result<Diagnostics> read_diagnostics(const std::filesystem::path& file,
                                     std::vector<std::string> only) {
  if (!only.empty()) only.emplace_back(kStamp);
  const auto table = CsvColumns::read(file, only);
  if (!table) return tl::unexpected(table.error());
  if (!table->has(kStamp)) {
    return failure(fmt::format("{}:1: expected the column {}", file.string(), kStamp));
  }
  const auto columns = columns_of(*table);
  if (!columns) return tl::unexpected(columns.error());
  Diagnostics diagnostics;
  diagnostics.series = series_in(table->header());
  for (std::size_t i = 0; i < table->rows(); ++i) {
    ScanRow& scan = diagnostics.scans.emplace_back();
    scan.stamp = from_seconds(columns->at(kStamp)[i]);
    scan.covariance = covariance_at(*columns, i);
    for (const SeriesInfo& info : diagnostics.series) {
      scan.values.push_back(columns->at(info.name)[i]);
    }
  }
  return diagnostics;
}

CsvTable waypoint_times_table(const std::vector<WaypointTime>& waypoint_times) {
  CsvTable table({"point", "stamp_s"});
  for (const WaypointTime& waypoint_time : waypoint_times) {
    table.add(waypoint_time.point).add(to_seconds(waypoint_time.stamp)).end_row();
  }
  return table;
}

CsvTable scores_csv(std::span<const RunRecord> runs) {
  CsvTable table({"seed", "estimator", "score", "value"});
  for (const RunRecord& run : runs) {
    if (!is_valid_run(run)) {
      table.add(run.seed).add("").add("robot.valid").add(0.0).end_row();
      continue;
    }
    for (const auto& [estimator, unused] : run.scores["estimators"].items()) {
      for (const std::string& key : score_keys(run, estimator)) {
        table.add(run.seed).add(estimator).add(key);
        table.add(find_score(run, estimator, key)).end_row();
      }
    }
  }
  return table;
}

}  // namespace aims
