// SPDX-License-Identifier: BSD-3-Clause
#include "bench/scoring/score_record.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "bench/metrics/statistics.hpp"
#include "bench/metrics/success.hpp"
#include "bench/scoring/health_summary.hpp"
#include "bench/scoring/validity.hpp"

namespace aims {
namespace {

/// An estimate of a whole run covers more of its time [-].
constexpr double kWhole = 0.9;

Json weak_axis_json(const std::vector<WeakAxisScore>& scores) {
  Json json = Json::object();
  for (const WeakAxisScore& score : scores) {
    json[score.level] = {{"scans", score.scans},
                         {"error_rms_m", json_of(score.error_rms_m)},
                         {"bound_rms_m", json_of(score.bound_rms_m)},
                         {"efficiency", json_of(score.efficiency)},
                         {"nees", json_of(score.nees)}};
  }
  return json;
}

/// What of a record holds whoever estimates.
Json run_part(const RunRecord& record) {
  Json part = Json::object();
  for (const char* key : {"simulated_s", "robot", "localizability"}) {
    if (record.scores.contains(key)) part[key] = record.scores[key];
  }
  return part;
}

}  // namespace

Json time_json(const std::vector<double>& times_ms) {
  const auto summary = summarize(times_ms);
  return {{"mean", json_of(summary, &Summary::mean)},
          {"p50", json_of(summary, &Summary::p50)},
          {"p99", json_of(summary, &Summary::p99)}};
}

Json estimator_json(const EstimatorOutcome& outcome) {
  Json json = scores_json(outcome.scores);
  json["weak_axis"] = weak_axis_json(outcome.weak_axis);
  json["time_per_scan_ms"] = time_json(outcome.scan_times.wall_ms);
  json["cpu_per_scan_ms"] = time_json(outcome.scan_times.cpu_ms);
  json["poses"] = outcome.scores.poses;
  json["poses_invalid"] = outcome.scores.poses_invalid;
  json["counts"] = outcome.result.counts;
  json["health"] = health_json(health_summary(outcome.result.health));
  if (outcome.scores.failure_reason == FailureReason::kErrorLimit && outcome.scores.diverged_at) {
    json["health"]["healthy_while_wrong_s"] =
        healthy_after(outcome.result.health, *outcome.scores.diverged_at);
  }
  if (outcome.optimized) {
    json["optimized"] = scores_json(*outcome.optimized);
    json["optimized"]["poses"] = outcome.optimized->poses;
  }
  return json;
}

Json segments_json(const Scores& scores) {
  return json_array(scores.segments, [](const SegmentDistance& distance) {
    return Json{{"name", distance.segment.name}, {"length_m", distance.true_distance_m}};
  });
}

const Json& estimator_in(const RunRecord& record, const std::string& estimator) {
  static const Json none;
  const auto estimators = record.scores.find("estimators");
  if (estimators == record.scores.end() || !estimators->contains(estimator)) return none;
  return estimators->at(estimator);
}

void visit_leaves(const Json& json, const std::string& prefix,
                  const std::function<void(const std::string&, const Json&)>& visit) {
  for (const auto& [key, value] : json.items()) {
    const std::string full = prefix.empty() ? key : prefix + "." + key;
    if (value.is_object()) {
      visit_leaves(value, full, visit);
    } else {
      visit(full, value);
    }
  }
}

std::optional<double> number_at(const Json& json, std::string_view key) {
  if (!json.is_object()) return std::nullopt;
  for (const auto& [name, value] : json.items()) {
    if (!key.starts_with(name)) continue;
    const std::string_view rest = key.substr(name.size());
    std::optional<double> found;
    if (rest.empty() && value.is_number()) found = value.get<double>();
    if (rest.empty() && value.is_boolean()) found = value.get<bool>() ? 1.0 : 0.0;
    if (rest.starts_with('.')) found = number_at(value, rest.substr(1));
    if (found) return found;
  }
  return std::nullopt;
}

bool failed_in(const RunRecord& record, const std::string& estimator) {
  const Json failures = value_in(record.scores, "failures", Json::array());
  return std::ranges::any_of(
      failures, [&](const Json& each) { return value_in(each, "estimator", "") == estimator; });
}

bool is_partial(const RunRecord& record, const std::string& estimator) {
  if (!is_valid_run(record)) return false;
  return failed_in(record, estimator) || is_partial(estimator_in(record, estimator));
}

bool is_partial(const Json& scores) {
  if (scores.is_null() || value_in(scores, "success", false)) return false;
  const std::string reason = value_in(scores, "diverged_reason", "");
  const bool lacks_poses = !reason.empty() && reason != name_of(FailureReason::kErrorLimit) &&
                           reason != name_of(FailureReason::kInvalidRun);
  // Older results know the first failure and how much is covered.
  const bool covers_less = number_at(scores, "coverage").value_or(1.0) < kWhole;
  return value_in(scores, "partial", lacks_poses || covers_less);
}

std::vector<std::string> estimators_in(std::span<const RunRecord> runs) {
  std::vector<std::string> names;
  const auto add = [&](const std::string& name) {
    if (!name.empty() && std::ranges::find(names, name) == names.end()) names.push_back(name);
  };
  for (const RunRecord& run : runs) {
    const Json scores = value_in(run.scores, "estimators", Json::object());
    for (const auto& [name, unused] : scores.items()) add(name);
  }
  for (const RunRecord& run : runs) {
    for (const Json& each : value_in(run.scores, "failures", Json::array())) {
      add(value_in(each, "estimator", ""));
    }
  }
  return names;
}

bool has_outcome(const RunRecord& record) {
  return !value_in(record.scores, "estimators", Json::object()).empty() ||
         !value_in(record.scores, "failures", Json::array()).empty();
}

std::optional<double> find_score(const RunRecord& record, const std::string& estimator,
                                 const std::string& key) {
  return number_at(estimator_in(record, estimator), key);
}

std::optional<double> find_run_score(const RunRecord& record, const std::string& key) {
  return number_at(run_part(record), key);
}

std::vector<std::string> run_score_keys(const RunRecord& record) {
  std::vector<std::string> keys;
  visit_leaves(run_part(record), "", [&](const std::string& name, const Json& value) {
    if (value.is_number() || value.is_boolean()) keys.push_back(name);
  });
  return keys;
}

std::string optimized_label(const std::string& estimator) { return estimator + " (optimized)"; }

bool has_optimized(const RunRecord& record, const std::string& estimator) {
  const Json& json = estimator_in(record, estimator);
  return json.is_object() && json.contains("optimized");
}

Scores undefined_scores(const ScoreConfig& scoring) {
  Scores scores = score_over({}, {}, {}, scoring);
  scores.drift = DriftSummary();
  if (scoring.sim3) scores.sim3_scale = 1.0;
  return scores;
}

std::vector<std::string> score_keys(const RunRecord& record, const std::string& estimator) {
  std::vector<std::string> keys;
  visit_leaves(estimator_in(record, estimator), "",
               [&](const std::string& name, const Json& value) {
                 if (!value.is_string()) keys.push_back(name);
               });
  return keys;
}

}  // namespace aims
