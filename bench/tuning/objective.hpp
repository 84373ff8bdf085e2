// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "bench/jobs/job.hpp"
#include "bench/tuning/design.hpp"
#include "core/config.hpp"
#include "core/error.hpp"

namespace aims {

/// Statistic of a score over many runs.
enum class ObjectiveStatistic { kMedian, kWorst, kMean, kQuantile };

/// One number for many runs, of which less is better: a statistic of their *scores*, which are as
/// measured, with a penalty for those that diverged.
struct Objective {
  std::string score = "ate_yaw_m";  ///< dotted key of scores.json, e.g. "m_list_percent.all"
  ObjectiveStatistic statistic = ObjectiveStatistic::kMedian;
  double quantile = 0.9;  ///< for `kQuantile`, in (0, 1)
  /// Each score over that of the defaults on the same sequence; where these were lost without one,
  /// over the median of the points.
  bool relative = true;
  /// Asked to be relative, but the defaults have a score of 0 somewhere: plain scores instead.
  bool without_ratio = false;
  /// Relative, and the defaults were lost without a score somewhere.
  bool lost_defaults = false;
  /// Value of a diverged run, and added times their fraction; 0: it counts by its score.
  double divergence_penalty = 10;
};

void describe(Fields& fields, Objective& objective);

/// "median of ate_m over that of the defaults; a diverged run counts 10, and ...".
std::string text_of(const Objective& objective);

/// "ate_m [m]", or "ate_m over the defaults'": what its values are.
std::string value_label(const Objective& objective);

/// "objective: ate_m [m]", for axes.
std::string axis_label(const Objective& objective);

/// One score of one run.
struct RunScore {
  std::optional<double> value;  ///< none: the run has no such score
  bool diverged = false;        ///< no success, or the job failed
  std::string invalid = {};     ///< why the run is invalid (validity.hpp); empty: it is valid
  std::string failure = {};     ///< why the job failed; empty: it did not
};

/// The score of that key of a job. A job that failed is a diverged run; an invalid run has no score
/// and is not diverged. An estimate that leaves a part of the run out (`is_partial`) has no score.
RunScore run_score(const JobResult& job, const std::string& score);

/// Counts for a run that failed before it had a score, where there is no penalty.
inline constexpr double kWithoutScore = 10.0;

/// The statistic over the runs, plus the penalty times the fraction of diverged runs. A diverged
/// run counts as the penalty in the statistic, or as its score where that is more. Where the
/// objective is relative, `reference` has the runs of the default setting on the same sequences: a
/// run counts 1 where that failed, and is left out without a positive reference unless it diverged.
/// Invalid runs are left out. None when no run is left.
std::optional<double> objective_value(const Objective& objective, std::span<const RunScore> runs,
                                      std::span<const RunScore> reference);

/// One sequence on which every point was run.
struct ResponseCase {
  std::string scenario;
  std::string family;  ///< of the scenario; its own name when it has none
  std::uint64_t seed = 0;
};

/// One score over points of a design and sequences.
struct ResponseTable {
  std::vector<ParameterRange> ranges;
  std::vector<ResponseCase> cases;
  std::vector<std::vector<double>> points;  ///< a value per range
  std::vector<std::vector<RunScore>> runs;  ///< per point and case
  std::vector<double> defaults;             ///< the default values per range
  std::vector<RunScore> default_runs;       ///< per case; empty: were not run
};

/// Indices of the cases of one family, or of all for "".
std::vector<std::size_t> cases_of(const ResponseTable& table, const std::string& family);

/// Cases of each seed, by seed and scenario. A seed draws the same sensors in each scenario, so
/// that statistics resample seeds, not their cases.
using SeedGroups = std::vector<std::vector<std::size_t>>;
SeedGroups cases_by_seed(const ResponseTable& table, std::span<const std::size_t> cases);

/// The cases of the groups with the indices `drawn`.
std::vector<std::size_t> joined(const SeedGroups& groups, std::span<const std::size_t> drawn);

/// The points of the table, of those with the same values the first: an optimizer comes back to
/// some, which is no further evidence.
std::vector<std::size_t> distinct_points(const ResponseTable& table);

/// How many of them are not the defaults.
std::size_t other_points(const ResponseTable& table);

/// The families of the table's cases, in the order in which they appear.
std::vector<std::string> families_of(const ResponseTable& table);

/// A line per case with invalid runs: "corridor seed 3: 5 of 13 runs are invalid and left out (the
/// robot fell at 1.2 s)".
std::vector<std::string> left_out_lines(const ResponseTable& table);

/// The same of jobs that failed: "corridor seed 3: 5 of 13 runs failed (no result after 600 s)".
std::vector<std::string> failed_lines(const ResponseTable& table);

/// Whether no run at all, of any point or the defaults, ended without diverging: such a table says
/// nothing about its parameters.
bool all_diverged(const ResponseTable& table);

/// Whether there are runs with the defaults and every valid one diverged: a gain over them, which
/// compares with the penalty, means nothing.
bool defaults_all_diverged(const ResponseTable& table);

/// What a report says then.
inline constexpr const char* kNoGain =
    "every run with the default values diverged, so that a gain over them means nothing";

/// The seeds of the table's cases, in the order in which they appear.
std::vector<std::uint64_t> seeds_of(const ResponseTable& table);

/// The objective over the cases with these indices (one may occur several times) of point `point`,
/// or of the defaults for `kDefaults`.
inline constexpr std::size_t kDefaults = static_cast<std::size_t>(-1);
const std::vector<RunScore>& runs_at(const ResponseTable& table, std::size_t point);
const std::vector<double>& values_at(const ResponseTable& table, std::size_t point);
std::optional<double> objective_at(const ResponseTable& table, const Objective& objective,
                                   std::size_t point, std::span<const std::size_t> cases);

/// Reduction of the objective from the defaults to a point, as a fraction of the defaults'.
std::optional<double> gain_over(const std::optional<double>& defaults,
                                const std::optional<double>& point);

/// Error, begun with `key`, for a score of which less is not better: objectives are minimized.
Result<void> check_direction(const std::string& key, const std::string& score);

/// The objective where the table has default runs with scores above 0, else that of plain scores.
Objective objective_for(Objective objective, const ResponseTable& table);

}  // namespace aims
