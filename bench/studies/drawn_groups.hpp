// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "bench/jobs/stored_results.hpp"
#include "bench/scoring/score_statistics.hpp"
#include "core/error.hpp"
#include "core/files/csv.hpp"
#include "core/files/table.hpp"

namespace aims {

/// Upper ends of at most `bins` bins of about equal numbers of values; equal values are in one bin,
/// and the last end is the largest value.
std::vector<double> upper_ends(std::vector<double> values, std::size_t bins);

/// One estimator over the runs of a group.
struct GroupScores {
  std::string estimator;
  std::size_t runs = 0;  ///< valid ones, with those on which it failed
  std::size_t successes = 0;
  std::size_t failed = 0;                      ///< of the runs
  bool partial = false;                        ///< of some run the estimate lacks a part
  SuccessRate strict;                          ///< within 1 %
  std::vector<std::optional<double>> medians;  ///< in the order of `headline_scores()`
};

/// Runs of one scenario whose drawn value is the same or lies in one bin.
struct DrawnGroup {
  std::string scenario;
  std::string label;           ///< "left", "0", "1.2 to 1.9"
  std::optional<double> low;   ///< of the group's values; none of texts
  std::optional<double> high;  ///< likewise
  std::size_t invalid = 0;     ///< runs left out
  std::vector<GroupScores> estimators;
};

/// The runs grouped by the quantity `key` that the seeds drew (`drawn` of scores.json). Numbers of
/// more than `bins` different values are divided into bins of about equal numbers of runs; equal
/// values stay together. Error when no run has that key, with those that there are.
Result<std::vector<DrawnGroup>> group_by_drawn(const StoredResults& results, const std::string& key,
                                               std::size_t bins);

/// A row per group and estimator.
TextTable groups_table(const std::vector<DrawnGroup>& groups);

/// What the marks mean that stand in that table; empty without one.
std::string groups_legend(const std::vector<DrawnGroup>& groups);

/// What groups.json holds (schema aims.groups/1).
Json groups_json(const std::vector<DrawnGroup>& groups, const std::string& key,
                 const std::string& folder);

/// Writes groups.json, groups.csv and groups.md into `folder`, which is made.
Result<void> write_groups(const std::vector<DrawnGroup>& groups, const std::string& key,
                          const std::string& source, const std::filesystem::path& folder);

}  // namespace aims
