// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/time.hpp"

namespace aims {

/// A quantity that an estimator reports once per scan.
struct SeriesInfo {
  std::string name;     ///< of its column in the diagnostics file
  std::string unit;     ///< "-" for a pure number
  std::string meaning;  ///< one phrase
};

/// A series and the quantity of a `Report` on one scan that it shows.
template <class Report>
struct ReportedSeries {
  const char* name;
  const char* unit;
  const char* meaning;
  double (*value)(const Report&);
};

/// The tables one after the other.
template <class Series, std::size_t... sizes>
constexpr std::array<Series, (sizes + ...)> joined(const std::array<Series, sizes>&... tables) {
  std::array<Series, (sizes + ...)> all{};
  auto end = all.begin();
  ((end = std::copy(tables.begin(), tables.end(), end)), ...);
  return all;
}

/// Name, unit and meaning of each of `table`, whose elements are `ReportedSeries`.
template <class Table>
std::vector<SeriesInfo> series_of(const Table& table) {
  std::vector<SeriesInfo> infos;
  for (const auto& each : table) infos.push_back({each.name, each.unit, each.meaning});
  return infos;
}

/// The values of `report` in the order of `table`.
template <class Table, class Report>
std::vector<double> values_of(const Table& table, const Report& report) {
  std::vector<double> values;
  values.reserve(std::size(table));
  for (const auto& each : table) values.push_back(each.value(report));
  return values;
}

/// Covariance that an estimator states for its pose, body axes.
struct PoseCovariance {
  Eigen::Matrix3d position = Eigen::Matrix3d::Zero();  ///< [m^2]
  Eigen::Matrix3d rotation = Eigen::Matrix3d::Zero();  ///< [rad^2]
};

/// What an estimator reports of one scan: a row of the diagnostics file.
struct ScanRow {
  Time stamp = 0;                            ///< end of the scan
  std::optional<PoseCovariance> covariance;  ///< after the scan; none where none is stated
  std::vector<double> values;                ///< one per series; NaN: not computed
};

/// Series of the number of LiDAR iterations; 0 marks a scan without an update. An estimator
/// without this series updates with every scan.
inline constexpr std::string_view kIterationsSeries = "iterations";

/// Named series over scans. Which series there are is up to the estimator.
struct Diagnostics {
  std::vector<SeriesInfo> series;
  std::vector<ScanRow> scans;

  /// Index of the series `name` in `ScanRow::values`; empty when there is none.
  std::optional<std::size_t> find(std::string_view name) const;

  /// Value of the series `name` at scan `scan`; NaN where it is not computed or does not exist.
  double value(std::size_t scan, std::string_view name) const;

  /// Whether scan `scan` corrected the estimate.
  bool updated(std::size_t scan) const;
};

}  // namespace aims
