// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "bench/jobs/stored_results.hpp"
#include "bench/metrics/statistics.hpp"
#include "core/error.hpp"
#include "core/files/table.hpp"

namespace aims {

struct OrderOptions {
  std::string adaptive = "aims";  ///< estimator with weights that adapt
  std::string fixed = "tfs";      ///< with fixed ones
  std::string score = "ate_m";    ///< of both; smaller is better
  std::size_t bins = 4;           ///< of each condition
};

/// A valid run whose seed drew its conditions, and in which both estimators have a score.
struct OrderUnit {
  std::string scenario;
  std::uint64_t seed = 0;
  std::map<std::string, double> conditions;  ///< drawn numbers by key
  double advantage = 0.0;  ///< score of the fixed one minus that of the adaptive one
  /// Agreement with the paper's order: mean of Kendall's tau over the columns of its table I.
  std::optional<double> tau;
};

/// Units whose condition lies in one bin, or in one cell of two conditions.
struct OrderBin {
  double low = 0.0;  ///< of the condition
  double high = 0.0;
  std::size_t units = 0;
  std::size_t better = 0;     ///< in which the adaptive one is better
  double advantage = 0.0;     ///< median
  Interval interval;          ///< of it, 95 %, bootstrap over units
  std::optional<double> tau;  ///< mean
};

/// What one condition does to the advantage.
struct OrderCondition {
  std::string key;
  double association = 0.0;               ///< Kendall's tau between condition and advantage
  Interval interval;                      ///< 95 %, bootstrap over units
  std::optional<double> tau_association;  ///< likewise of the agreement with the paper
  std::vector<OrderBin> bins;
};

/// The advantage over two conditions.
struct OrderMap {
  std::string x, y;  ///< keys of the conditions
  struct Cell {
    double x, y;  ///< medians of the conditions in their bins
    std::optional<OrderBin> bin;
  };
  std::vector<Cell> cells;
};

/// Under which conditions adaptive weights help, and the paper's order holds.
struct OrderStudy {
  OrderOptions options;
  std::vector<OrderUnit> units;
  std::size_t left_out = 0;  ///< runs that are invalid, or in which one of the two has no score
  OrderBin all;
  std::vector<OrderCondition> conditions;  ///< the strongest association first
  std::optional<OrderMap> map;             ///< over the two strongest; none with fewer
};

/// Error when no run drew a number, or has both estimators.
Result<OrderStudy> order_study(const StoredResults& results, const OrderOptions& options);

/// A row per condition and bin.
TextTable conditions_table(const OrderStudy& study);

/// The map: a row per bin of y, a column per bin of x.
TextTable map_table(const OrderMap& map);

/// One line on all units.
std::string summary_text(const OrderStudy& study);

/// Writes order.md, order.json and order.csv (a row per unit) into `folder`.
Result<void> write_order(const OrderStudy& study, const std::string& source,
                         const std::filesystem::path& folder);

}  // namespace aims
