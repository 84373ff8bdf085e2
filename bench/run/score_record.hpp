// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "bench/run/run.hpp"
#include "bench/run/scenario.hpp"

namespace aims {

using Json = nlohmann::ordered_json;

/// Version of the layout of scores.json; see docs/results.md.
inline constexpr std::string_view kScoresSchema = "aims.scores/1";

/// The number, or null for none and for what is not finite.
Json json_of(const std::optional<double>& value);

/// What scores.json holds of one run.
struct RunRecord {
  std::uint64_t seed = 0;
  Json scores;
};

/// What scores.json holds of any estimate.
Json scores_json(const Scores& scores);

/// What scores.json holds of one estimator of a run.
Json estimator_json(const EstimatorOutcome& outcome);

/// The segments with their true straight lengths, which are the same for every estimate.
Json segments_json(const Scores& scores);

/// The record of a run; `drawing_s` is the wall time [s] spent on its pictures.
RunRecord record_of(const Scenario& scenario, const RunResult& result, double drawing_s);

/// Adds to `record` the estimators of `from` that it does not have; both are of the same scenario
/// and seed. Gates follow; the order becomes that of the registry.
void take_estimators(const Scenario& scenario, const RunRecord& from, RunRecord& record);

/// One number of an estimator in a record, by dotted key ("m_list_percent.a-b"); empty when it has
/// no value (a segment not walked, a lost estimator) or does not exist.
std::optional<double> find_score(const RunRecord& record, const std::string& estimator,
                                 const std::string& key);

/// Dotted keys of every number that an estimator of the record has.
std::vector<std::string> score_keys(const RunRecord& record, const std::string& estimator);

}  // namespace aims
