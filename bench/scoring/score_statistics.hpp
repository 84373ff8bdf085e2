// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "bench/metrics/statistics.hpp"
#include "bench/scoring/score_record.hpp"

namespace aims {

/// One score of one estimator over runs of the same scenario. As everywhere below, invalid runs
/// (bench/scoring/validity.hpp) are left out.
struct ScoreStatistics {
  std::optional<double> median;  ///< over the runs that have a value
  std::optional<double> worst;   ///< largest; smallest of a score of which more is better
  std::size_t count = 0;         ///< runs that have a value
};

ScoreStatistics statistics_of(std::span<const RunRecord> runs, const std::string& estimator,
                              const std::string& key);

/// Whether the estimate lacks a part of some run (`is_partial`), so that statistics are of less
/// than those of others.
bool any_partial(std::span<const RunRecord> runs, const std::string& estimator);

/// The estimators of a record of which the estimate lacks a part, or that failed.
std::vector<std::string> partial_in(const RunRecord& record);

/// Valid runs on which the estimator failed.
std::size_t failed_runs(std::span<const RunRecord> runs, const std::string& estimator);

/// The first valid run in which that estimator has scores, of any with an empty name: it has all
/// segments of the route. Null without one.
const RunRecord* example_run(std::span<const RunRecord> runs, const std::string& estimator = "");

/// Dotted keys of the scores of the estimator, by its first valid run.
std::vector<std::string> score_keys_in(std::span<const RunRecord> runs,
                                       const std::string& estimator);

/// " part", behind a figure of which that holds; else nothing.
std::string part_mark(bool partial);

/// What that mark means, as a line of a legend.
inline constexpr const char* kPartLegend =
    "part: over the parts of the runs that have poses alone.\n";

/// The largest value; the smallest of a score of which more is better.
std::optional<double> worst_of(const std::vector<double>& values, const std::string& key);

/// A change of at most this is too small to matter, whatever its significance: the larger of 5 % of
/// the value before and of what is of no interest of a headline score, e.g. 1 cm.
inline constexpr double kMinChange = 0.05;
double smallest_change(const std::string& key, double before);

/// 95 % bootstrap interval of the median of a score over the runs that have it; coarse below about
/// ten runs.
Interval median_interval(std::span<const RunRecord> runs, const std::string& estimator,
                         const std::string& key);

/// Runs in which the estimator finished, and those in which it was a success; by the key
/// `kStrictSuccessKey` within 1 %, with `kOptimizedPrefix` before it its re-optimized trajectory.
std::size_t finished(std::span<const RunRecord> runs, const std::string& estimator);
std::size_t successes(std::span<const RunRecord> runs, const std::string& estimator,
                      const std::string& key = kSuccessKey);

/// Successes of so many runs.
struct SuccessRate {
  std::size_t count = 0;
  std::size_t runs = 0;

  Interval interval() const { return wilson_interval(count, runs); }
  /// "18/20 (70-97 %)": count, runs and 95 % Wilson interval; "-" without runs.
  std::string text() const;
};

/// Over the valid runs that have the key, and those on which the estimator failed: older results
/// have none of 1 %.
SuccessRate success_rate(std::span<const RunRecord> runs, const std::string& estimator,
                         const std::string& key = kSuccessKey);

/// Whether the estimator has a success by that key in that run: none where it failed. Without a
/// value when it has no such key, or when the run is invalid.
std::optional<bool> succeeds(const RunRecord& run, const std::string& estimator,
                             const std::string& key = kSuccessKey);

/// The score as it counts beside those of others: a run that lacks a part of the estimate
/// (`is_partial`) is a lost success and has no other.
std::optional<double> compared_score(const RunRecord& run, const std::string& estimator,
                                     const std::string& key);

/// Values of one score in pairs of runs on the same seed.
struct ScorePairs {
  std::vector<double> reference;
  std::vector<double> value;

  std::vector<double> differences() const;  ///< value - reference
};

/// One estimator in some runs.
struct EstimatorRuns {
  std::span<const RunRecord> runs;
  std::string estimator;
};

/// Runs that lack a part of the estimate (`is_partial`) are lost successes and have no other
/// scores.
ScorePairs paired(const EstimatorRuns& reference, const EstimatorRuns& other,
                  const std::string& key);

/// Where two estimators differ in success.
struct SuccessTest {
  std::size_t sequences = 0;    ///< on which both have one
  std::size_t seeds = 0;        ///< of these sequences
  std::size_t only_first = 0;   ///< sequences on which the first alone succeeds
  std::size_t only_second = 0;  ///< likewise
  /// Sign test over seeds (Dixon and Mood 1946): on how many the first, or the second, succeeds on
  /// more sequences. The sequences of a seed are not independent, since its sensors are the same
  /// in each scenario. With one sequence per seed it is McNemar's exact test.
  McNemarTest by_seed;
};

/// Collects the successes of two estimators on the same sequences.
class SuccessDifferences {
 public:
  void add(std::uint64_t seed, bool first, bool second);
  SuccessTest test() const;

 private:
  SuccessTest counts_;
  std::map<std::uint64_t, int> surplus_;  ///< per seed: successes of the first minus the second's
};

/// Of two estimators on the same seeds of one scenario.
McNemarTest success_test(const EstimatorRuns& first, const EstimatorRuns& second,
                         const std::string& key = kSuccessKey);

/// What pairs of runs say about a change of a score.
struct PairedStatistics {
  std::size_t count = 0;                   ///< pairs
  std::optional<double> reference_median;  ///< none without pairs, like the next ones
  std::optional<double> median;
  std::optional<double> worst;  ///< largest
  std::optional<double> ratio;  ///< of the medians; none unless the reference's is positive
  double change = 0.0;          ///< mean of the differences
  Interval interval;            ///< of the change: 95 %, bootstrap over pairs
};

PairedStatistics statistics_of(const ScorePairs& pairs);

/// 95 % bootstrap interval of the mean.
Interval mean_interval(const std::vector<double>& values);

}  // namespace aims
