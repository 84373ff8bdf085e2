// SPDX-License-Identifier: BSD-3-Clause
#include "bench/estimate/estimate_summary.hpp"

#include <fmt/format.h>

#include <utility>

#include "bench/estimate/estimate_log.hpp"
#include "bench/metrics/statistics.hpp"
#include "bench/scoring/health_summary.hpp"
#include "bench/scoring/json_text.hpp"
#include "bench/scoring/result_files.hpp"
#include "bench/scoring/score_record.hpp"
#include "bench/scoring/tables.hpp"
#include "bench/scoring/trajectory_summary.hpp"
#include "core/files/atomic_file.hpp"
#include "core/files/config_dump.hpp"
#include "core/files/tum.hpp"

namespace aims {
namespace {

namespace fs = std::filesystem;

double realtime_factor(const EstimateResult& result, const EstimatorOutcome& outcome) {
  return outcome.wall_s > 0.0 ? result.recorded_s / outcome.wall_s : 0.0;
}

Json estimator_json(const EstimateResult& result, const EstimatorOutcome& outcome) {
  const EstimatorTotals& totals = outcome.totals;
  Json json;
  json["poses"] = totals.poses;
  json["scans"] = totals.scans;
  json["path_m"] = json_of(totals.path_m);
  json["displacement_m"] =
      json_of((totals.last_pose.translation - totals.first_pose.translation).norm());
  json["wall_s"] = outcome.wall_s;
  json["realtime_factor"] = realtime_factor(result, outcome);
  json["time_per_scan_ms"] = time_json(outcome.scan_times.wall_ms);
  json["cpu_per_scan_ms"] = time_json(outcome.scan_times.cpu_ms);
  json["counts"] = outcome.result.counts;
  json["health"] = health_json(totals.health);
  return json;
}

Json pose_json(const Pose& pose) {
  const Eigen::Vector3d& p = pose.translation;
  const Eigen::Quaterniond& q = pose.rotation;
  return {{"translation", {p.x(), p.y(), p.z()}},
          {"quaternion_xyzw", {q.x(), q.y(), q.z(), q.w()}}};
}

/// The configuration, which repeats the estimate.
std::string config_text(const EstimateConfig& config) {
  EstimateConfig used = config;
  return dump_config(fields_of(used));
}

}  // namespace

Json topics_json(const TopicsConfig& topics) {
  return {{"lidar", topics.lidar},
          {"imu", topics.imu},
          {"leg_odometry", topics.leg_odometry},
          {"joint_states", topics.joint_states},
          {"contacts", topics.contacts},
          {"truth", topics.truth}};
}

Json estimate_json(const EstimateResult& result) {
  Json json = {{"schema", "aims.estimate/1"},
               {"version", AIMS_VERSION},
               {"bag", result.bag.string()},
               {"complete", result.complete && !result.broken},
               {"error", result.broken ? Json(result.broken->message) : Json()},
               {"recorded_s", result.recorded_s},
               {"wall_s", result.wall_s},
               {"topics", topics_json(result.setup.topics)},
               {"T_body_lidar", pose_json(result.setup.rig.T_body_lidar)},
               {"T_body_base", pose_json(result.setup.rig.T_body_base)},
               {"imu_rate_hz", result.setup.rig.imu_rate_hz},
               {"leg_rate_hz", result.setup.rig.leg_rate_hz},
               {"notes", result.setup.notes},
               {"warnings", json_array(result.setup.warnings, &ReadingWarning::text)},
               {"counts", result.counts}};
  for (const EstimatorOutcome& each : result.estimators) {
    json["estimators"][each.name] = estimator_json(result, each);
  }
  json["failures"] = Json::object();
  for (const EstimatorFailure& each : result.failures) json["failures"][each.name] = each.message;
  return json;
}

RunRecord estimate_record(const EstimateResult& result) {
  RunRecord record = record_of(*result.scores);
  record.scores["complete"] = result.complete && !result.broken;
  if (!result.complete) record.scores["interrupted"] = true;
  for (const EstimatorOutcome& each : result.estimators) {
    Json& json = record.scores["estimators"][each.name];
    json["time_per_scan_ms"] = time_json(each.scan_times.wall_ms);
    json["cpu_per_scan_ms"] = time_json(each.scan_times.cpu_ms);
    json["counts"] = each.result.counts;
    json["health"] = health_json(each.totals.health);
    const auto unnoticed = result.healthy_while_wrong_s.find(each.name);
    if (unnoticed != result.healthy_while_wrong_s.end()) {
      json["health"]["healthy_while_wrong_s"] = unnoticed->second;
    }
    Json& estimators = record.scores["estimators"];
    const std::string label = optimized_label(each.name);
    if (!estimators.contains(label)) continue;
    Json optimized = std::move(estimators[label]);
    estimators.erase(label);
    estimators[each.name]["optimized"] = std::move(optimized);
  }
  return record;
}

TextTable estimate_table(const EstimateResult& result) {
  TextTable table;
  if (result.scores) table = trajectory_score_table(*result.scores);
  if (table.rows.empty()) {
    table.header = {"estimator"};
    for (const EstimatorOutcome& each : result.estimators) table.rows.push_back({each.name});
  }
  for (const char* title : {"poses", "path m", "CPU ms/scan", "x real time"}) {
    table.header.emplace_back(title);
  }
  for (std::size_t i = 0; i < result.estimators.size(); ++i) {
    const EstimatorOutcome& each = result.estimators[i];
    const auto times = summarize(each.scan_times.cpu_ms);
    table.rows[i].push_back(std::to_string(each.totals.poses));
    table.rows[i].push_back(fmt::format("{:.2f}", each.totals.path_m));
    table.rows[i].push_back(times ? fmt::format("{:.2f}", times->mean) : "-");
    table.rows[i].push_back(fmt::format("{:.1f}", realtime_factor(result, each)));
  }
  for (std::size_t i = result.estimators.size(); i < table.rows.size(); ++i) {
    table.rows[i].resize(table.header.size(), "-");  // of re-optimized trajectories
  }
  return table;
}

Result<void> write_estimate(const EstimateConfig& config, const EstimateResult& result,
                            const fs::path& folder) {
  auto written = write_file_atomically(folder / "config.yaml", config_text(config));
  if (written) {
    written = write_json(folder / "estimate.json", estimate_json(result));
  }
  for (const EstimatorOutcome& each : result.estimators) {
    if (!written) break;
    written = result.folder.empty() ? write_estimator(each, folder, each.name)
                                    : write_map_and_optimized(each, folder, each.name);
  }
  if (written && !result.scans.empty()) {
    written = write_csv(folder / "scans.csv", shown_scans_table(result.scans));
  }
  if (written && !result.truth.empty()) written = write_tum(folder / kTruthFile, result.truth);
  if (written && result.scores) written = write_record(estimate_record(result), folder);
  return written;
}

}  // namespace aims
