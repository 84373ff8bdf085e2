// SPDX-License-Identifier: BSD-3-Clause
#include "bench/run/score_record.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "bench/metrics/statistics.hpp"
#include "bench/run/health_summary.hpp"

namespace aims {
namespace {

using aims::json_of;

template <class Part, class Member>
Json json_of(const std::optional<Part>& part, Member Part::*member) {
  return part ? json_of(std::optional<double>(*part.*member)) : Json();
}

Json axis_json(const AxisError& error, bool has_attitude) {
  return {{"longitudinal", error.longitudinal_m},
          {"lateral", error.lateral_m},
          {"vertical", error.vertical_m},
          {"heading_rad", has_attitude ? Json(error.heading_rad) : Json()},
          {"tilt_rad", has_attitude ? Json(error.tilt_rad) : Json()}};
}

Json drift_json(const std::optional<DriftSummary>& drift) {
  if (!drift) return {};
  const bool attitude = drift->has_attitude;
  return {{"rmse", axis_json(drift->rmse, attitude)},
          {"max", axis_json(drift->max, attitude)},
          {"end", axis_json(drift->end, attitude)}};
}

/// M_list of each segment and, as "all", of their sum.
void add_segments(Json& json, const Scores& scores) {
  Json percent = Json::object();
  Json signed_percent = Json::object();
  for (const SegmentDistance& distance : scores.segments) {
    percent[distance.segment.name] = json_of(distance.percent);
    signed_percent[distance.segment.name] = json_of(distance.signed_percent);
  }
  percent["all"] = json_of(scores.m_list_percent);
  json["m_list_percent"] = std::move(percent);
  json["m_list_signed_percent"] = std::move(signed_percent);
}

/// Milliradians of an angle [rad].
Json mrad_json(const std::optional<double>& angle) {
  return angle ? json_of(1e3 * *angle) : Json();
}

void add_absolute_errors(Json& json, const Scores& scores) {
  json["ate_yaw_m"] = json_of(scores.ate_yaw_m);
  json["heading_error_mrad"] = mrad_json(scores.heading_error_rad);
  json["heading_offset_mrad"] = mrad_json(scores.heading_offset_rad);
  json["ape_yaw_m"] = {{"mean", json_of(scores.ape_yaw, &AbsoluteErrorStatistics::mean_m)},
                       {"median", json_of(scores.ape_yaw, &AbsoluteErrorStatistics::median_m)},
                       {"std", json_of(scores.ape_yaw, &AbsoluteErrorStatistics::std_m)},
                       {"max", json_of(scores.ape_yaw, &AbsoluteErrorStatistics::max_m)}};
  json["ate_m"] = json_of(scores.ate_m);
  json["ate_se3_m"] = json_of(scores.ate_se3_m);
  json["ate_se3_degenerate"] = scores.se3_spread != PositionSpread::kFull;
  if (scores.sim3_scale) {
    json["ate_sim3_m"] = json_of(scores.ate_sim3_m);
    json["sim3_scale"] = json_of(scores.sim3_scale);
  }
  json["max_error_m"] = json_of(scores.max_error_m);
  json["max_error_z_m"] = json_of(scores.max_abs_z_error_m);
}

void add_path_error(Json& json, const std::string& name, const PathError& error) {
  json["path_error_percent"][name] = json_of(error.translation_percent);
  json["path_error_deg_per_m"][name] = json_of(error.rotation_deg_per_m);
}

void add_relative_errors(Json& json, const Scores& scores) {
  for (const PathError& each : scores.path_errors.lengths) {
    add_path_error(json, std::to_string(std::lround(each.length_m)) + "m", each);
  }
  add_path_error(json, "all", scores.path_errors.all);

  for (const RpeScore& rpe : scores.rpe) {
    json["rpe_" + std::to_string(std::lround(rpe.delta)) + "m"] = {
        {"translation_m", json_of(rpe.translation_rmse_m)},
        {"rotation_rad", json_of(rpe.rotation_rmse_rad)}};
  }
}

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

Json json_of(const std::optional<double>& value) {
  return value && std::isfinite(*value) ? Json(*value) : Json();
}

Json time_json(const std::vector<double>& times_ms) {
  const auto summary = summarize(times_ms);
  return {{"mean", json_of(summary, &Summary::mean)},
          {"p50", json_of(summary, &Summary::p50)},
          {"p99", json_of(summary, &Summary::p99)}};
}

Json scores_json(const Scores& scores) {
  Json json;
  json["success"] = scores.success;
  json["success_1_percent"] = scores.success_1_percent;
  json["diverged_reason"] = name_of(scores.failure_reason);
  json["diverged_at_s"] = scores.diverged_at ? Json(to_seconds(*scores.diverged_at)) : Json();
  json["coverage"] = scores.coverage;
  add_segments(json, scores);
  json["m_end_m"] = json_of(scores.m_end, &EndError::norm_m);
  json["m_end_xy_m"] = json_of(scores.m_end, &EndError::xy_m);
  json["m_end_z_m"] = json_of(scores.m_end, &EndError::z_m);
  json["start_to_end_m"] = json_of(scores.start_to_end_m);
  if (scores.control_points) {
    json["control_points"] = {{"points", scores.control_points->points},
                              {"reached", scores.control_points->reached},
                              {"score", scores.control_points->score}};
  }
  add_absolute_errors(json, scores);
  add_relative_errors(json, scores);
  json["drift_m"] = drift_json(scores.drift);
  return json;
}

Json estimator_json(const EstimatorOutcome& outcome) {
  Json json = scores_json(outcome.scores);
  json["weak_axis"] = weak_axis_json(outcome.weak_axis);
  json["time_per_scan_ms"] = time_json(outcome.scan_times.wall_ms);
  json["cpu_per_scan_ms"] = time_json(outcome.scan_times.cpu_ms);
  json["poses"] = outcome.scores.poses;
  json["counts"] = outcome.result.counts;
  json["health"] = health_json(health_summary(outcome.result.health));
  if (outcome.optimized) {
    json["optimized"] = scores_json(*outcome.optimized);
    json["optimized"]["poses"] = outcome.optimized->poses;
  }
  return json;
}

Json segments_json(const Scores& scores) {
  Json segments = Json::array();
  for (const SegmentDistance& distance : scores.segments) {
    segments.push_back({{"name", distance.segment.name}, {"length_m", distance.true_distance_m}});
  }
  return segments;
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

std::optional<double> number_at(const Json& json, const std::string& key) {
  std::optional<double> found;
  visit_leaves(json, "", [&](const std::string& name, const Json& value) {
    if (name != key) return;
    if (value.is_number()) found = value.get<double>();
    if (value.is_boolean()) found = value.get<bool>() ? 1.0 : 0.0;
  });
  return found;
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

std::vector<std::string> score_keys(const RunRecord& record, const std::string& estimator) {
  std::vector<std::string> keys;
  visit_leaves(estimator_in(record, estimator), "",
               [&](const std::string& name, const Json& value) {
                 if (!value.is_string()) keys.push_back(name);
               });
  return keys;
}

}  // namespace aims
