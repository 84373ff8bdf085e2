// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "bench/jobs/stored_results.hpp"
#include "bench/metrics/paired_test.hpp"
#include "bench/metrics/statistics.hpp"
#include "bench/scoring/score_record.hpp"
#include "core/files/table.hpp"

namespace aims {

enum class ChangeVerdict {
  kWorse,
  kBetter,
  kTooFew,  ///< they differ, but fewer than kFewestPairs can show nothing
  kSmall,   ///< beyond noise, but too small to matter
  kNone,    ///< within noise
  kSame,    ///< equal in every pair
};

/// One score of one estimator in one scenario, before and after, over the seeds that have it on
/// both sides.
struct ScoreChange {
  std::string scenario;
  std::string estimator;
  std::string score;
  std::size_t pairs = 0;
  double before = 0.0;  ///< mean over them; test.change is after - before
  double after = 0.0;
  double worst_after = 0.0;            ///< largest; of a success the smallest
  double floor = 0.0;                  ///< a change of at most this is too small to matter
  PairedTest test;                     ///< of a success: McNemar's p and no interval
  std::optional<McNemarTest> success;  ///< of a success alone: before first
  ChangeVerdict verdict = ChangeVerdict::kNone;
  double false_alarm = 0.0;  ///< probability of better or worse with random signs
};

struct Comparison {
  std::vector<ScoreChange> changes;  ///< of every score on both sides
  /// Where settings on top of the scenarios differ ("key=value"), those of each side alone.
  std::vector<std::string> set_before;
  std::vector<std::string> set_after;
  /// "scenario, seed 1,2" whose sequence is another one before and after, by its duration and the
  /// lengths of its segments.
  std::vector<std::string> other_sequences;
  /// "label: aims_d before, aims_d+KEY=VALUE after" where a label stands for another estimator.
  std::vector<std::string> other_specs;
  std::vector<std::string> only_before;  ///< "scenario, estimator, seed 1,2"
  std::vector<std::string> only_after;
  /// "scenario, estimator" with valid runs before, none of which has a valid one after.
  std::vector<std::string> not_compared;
  /// As `only_before`, where the estimator fails after and not before, and the reverse: such runs
  /// are lost successes, and have no other scores.
  std::vector<std::string> fails_now;
  std::vector<std::string> fails_no_more;
  /// "after: scenario, estimator, seed 1,2" where an estimate leaves a part of the run out, by a
  /// gap, an early end or no poses: of these runs the success alone is compared.
  std::vector<std::string> partial;
  std::vector<std::string> invalid;    ///< runs left out: "before: corridor seed 3: the robot fell"
  double expected_false_alarms = 0.0;  ///< sum over the changes
};

/// Pairs the valid runs of the same scenario, seed and estimator. A change is better or worse when
/// the interval of `paired_test` excludes zero and the change exceeds both the score's own floor
/// (headline_scores()) and 5 % of the value before; one of the successes, when McNemar's exact p is
/// at most 0.05.
Comparison compare(const StoredResults& before, const StoredResults& after);

/// The comparison, noting settings that only one of the sides has.
Comparison with_settings(Comparison comparison, std::vector<std::string> before,
                         std::vector<std::string> after);

/// What differs beside the results: what is set on one side alone, sequences that are other ones,
/// and labels of other estimators; empty where nothing does.
std::string settings_text(const Comparison& comparison);

/// "better", "worse", "too few", "small", "none", "same".
std::string_view name_of(ChangeVerdict verdict);

/// Number of changes with that verdict.
std::size_t count(const Comparison& comparison, ChangeVerdict verdict);

/// Every change, the worse ones first, then in the order of the verdicts.
TextTable change_table(const Comparison& comparison);

/// One line: how many were compared, better, worse, and false alarms that are expected.
std::string summary_text(const Comparison& comparison);

/// How the verdicts come about, and what the numbers of pairs at hand can show.
std::string rule_text(const Comparison& comparison);

/// What compare.json holds; `before` and `after` name the two.
Json comparison_json(const Comparison& comparison, const std::string& before,
                     const std::string& after);

/// Writes compare.json (schema aims.compare/3) and compare.md into `folder`, which is made.
Result<void> write_comparison(const Comparison& comparison, const std::string& before,
                              const std::string& after, const std::filesystem::path& folder);

}  // namespace aims
