// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "bench/jobs/stored_results.hpp"
#include "bench/metrics/bootstrap.hpp"
#include "core/files/table.hpp"

namespace aims {

enum class ChangeVerdict {
  kNone,  ///< within noise, or too small to matter
  kBetter,
  kWorse,
  kUnknown,  ///< one common seed: a difference, and no measure of noise
};

/// One score of one estimator in one scenario, before and after.
struct ScoreChange {
  std::string scenario;
  std::string estimator;
  std::string score;
  std::size_t seeds = 0;  ///< that have the score on both sides
  double before = 0.0;    ///< median over them; of `success` the mean
  double after = 0.0;
  double change = 0.0;  ///< mean of the paired differences, after - before
  Interval interval;    ///< of the change, 95 %
  ChangeVerdict verdict = ChangeVerdict::kNone;
  /// Probability that better or worse is said when only chance gives the differences their signs.
  double false_alarm = 0.0;
};

struct Comparison {
  std::vector<ScoreChange> changes;      ///< of every score on both sides
  std::vector<std::string> only_before;  ///< "scenario, estimator, seed 1,2"
  std::vector<std::string> only_after;
  double expected_false_alarms = 0.0;  ///< sum over the changes
};

/// Pairs the runs of the same scenario, seed and estimator. A change is better or worse when the
/// bootstrap interval of its mean leaves out zero and it exceeds both the score's own floor
/// (kHeadlineScores) and 5 % of the value before. How often that rule speaks by chance is counted
/// by giving the same differences all other signs (at most 64 draws of them).
Comparison compare(const StoredResults& before, const StoredResults& after);

/// Number of changes with that verdict.
std::size_t count(const Comparison& comparison, ChangeVerdict verdict);

/// One line on how many were compared, and how much of it chance explains.
std::string summary_text(const Comparison& comparison);

/// What got better, worse, or differs on one seed, as a table; empty rows when nothing.
TextTable change_table(const Comparison& comparison, ChangeVerdict verdict);

/// What compare.json holds; `before` and `after` name the two.
Json comparison_json(const Comparison& comparison, const std::string& before,
                     const std::string& after);

/// Writes compare.json (schema aims.compare/1) and compare.md into `folder`, which is made.
Result<void> write_comparison(const Comparison& comparison, const std::string& before,
                              const std::string& after, const std::filesystem::path& folder);

}  // namespace aims
