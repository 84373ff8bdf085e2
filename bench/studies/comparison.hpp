// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "bench/jobs/results.hpp"
#include "bench/run/score_statistics.hpp"
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
  PairedStatistics pairs;  ///< over the seeds that have it on both sides, before as the reference
  double before = 0.0;     ///< median over them; of `success` the mean
  double after = 0.0;
  ChangeVerdict verdict = ChangeVerdict::kNone;
  /// Probability of the verdict better or worse when the signs of the differences are random.
  double false_alarm = 0.0;
};

struct Comparison {
  std::vector<ScoreChange> changes;      ///< of every score on both sides
  std::vector<std::string> only_before;  ///< "scenario, estimator, seed 1,2"
  std::vector<std::string> only_after;
  double expected_false_alarms = 0.0;  ///< sum over the changes
};

/// Pairs the runs of the same scenario, seed and estimator. A change is better or worse when the
/// bootstrap interval of its mean excludes zero and it exceeds both the score's own floor
/// (kHeadlineScores) and 5 % of the value before. Its rate of false alarms is counted by giving the
/// same differences all other signs (at most 64 draws of them).
Comparison compare(const StoredResults& before, const StoredResults& after);

/// Number of changes with that verdict.
std::size_t count(const Comparison& comparison, ChangeVerdict verdict);

/// One line: how many were compared, better, worse, and false alarms that are expected.
std::string summary_text(const Comparison& comparison);

/// What got better, worse, or differs on one seed, as a table; empty rows when nothing.
TextTable change_table(const Comparison& comparison, ChangeVerdict verdict);

/// What compare.json holds; `before` and `after` name the two.
Json comparison_json(const Comparison& comparison, const std::string& before,
                     const std::string& after);

/// Writes compare.json (schema aims.compare/2) and compare.md into `folder`, which is made.
Result<void> write_comparison(const Comparison& comparison, const std::string& before,
                              const std::string& after, const std::filesystem::path& folder);

}  // namespace aims
