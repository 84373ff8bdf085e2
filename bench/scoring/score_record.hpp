// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "bench/scoring/json_text.hpp"
#include "bench/scoring/outcome.hpp"
#include "bench/scoring/score_list.hpp"

namespace aims {

/// Version of the layout of scores.json; see docs/result-files.md.
inline constexpr std::string_view kScoresSchema = "aims.scores/2";

/// Keys of an estimator's success: within 5 % of the distance, and within 1 %.
inline constexpr const char* kSuccessKey = "success";
inline constexpr const char* kStrictSuccessKey = "success_1_percent";

/// The number, or the truth value as 0 or 1, at a dotted key of scores; none without one.
std::optional<double> number_at(const Json& json, std::string_view key);

/// What scores.json holds of one run.
struct RunRecord {
  std::uint64_t seed = 0;
  Json scores;
  /// By label, the estimator and its settings ("aims_d+KEY=VALUE"); empty: not known.
  std::map<std::string, std::string> specs = {};
};

/// Mean, median and 99th percentile of the times per scan [ms].
Json time_json(const std::vector<double>& times_ms);

/// What scores.json holds of one estimator of a run; the scores of a re-optimized trajectory stand
/// under `optimized`.
Json estimator_json(const EstimatorOutcome& outcome);

/// The segments with their true straight lengths, which are the same for every estimate.
Json segments_json(const Scores& scores);

/// What the record holds of that estimator; null when there is nothing.
const Json& estimator_in(const RunRecord& record, const std::string& estimator);

/// Calls `visit(key, value)` for every leaf of an object, keys dotted and below `prefix`.
void visit_leaves(const Json& json, const std::string& prefix,
                  const std::function<void(const std::string&, const Json&)>& visit);

/// Whether the estimator failed on that sequence, by an error or a crash: it has no scores.
bool failed_in(const RunRecord& record, const std::string& estimator);

/// Whether an estimate with these scores leaves a part of the run out: it is no success for another
/// reason than its error (a gap, an early end, no poses). Its scores are of other stretches than
/// those of others and compare with none.
bool is_partial(const Json& scores);

/// The same of an estimator in a record of a valid run; also where it failed.
bool is_partial(const RunRecord& record, const std::string& estimator);

/// Labels of the estimators of any run, then of those that failed on all.
std::vector<std::string> estimators_in(std::span<const RunRecord> runs);

/// Whether an estimator has scores or failed; otherwise the record says nothing of estimators.
bool has_outcome(const RunRecord& record);

/// One number of an estimator in a record, by dotted key ("m_list_percent.a-b"); empty when it has
/// no value (a segment that was not reached, an estimator that diverged) or does not exist.
std::optional<double> find_score(const RunRecord& record, const std::string& estimator,
                                 const std::string& key);

/// One number of what the record holds whoever estimates ("robot.fell", which is 1 or 0); likewise.
std::optional<double> find_run_score(const RunRecord& record, const std::string& key);

/// Dotted keys of those numbers.
std::vector<std::string> run_score_keys(const RunRecord& record);

/// Name of that trajectory's row in a table.
std::string optimized_label(const std::string& estimator);

/// Whether the record scores a re-optimized trajectory of the estimator.
bool has_optimized(const RunRecord& record, const std::string& estimator);

/// Scores without values that have every key which an estimate can have with these settings.
Scores undefined_scores(const ScoreConfig& scoring);

/// Dotted keys of every number that an estimator of the record has.
std::vector<std::string> score_keys(const RunRecord& record, const std::string& estimator);

}  // namespace aims
