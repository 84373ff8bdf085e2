// SPDX-License-Identifier: BSD-3-Clause
#include "bench/run/weak_axis_series.hpp"

#include <cmath>
#include <map>

namespace aims {
namespace {

constexpr const char* kGroup = "weak_axis_series";

/// Deviation along the weak axis that IMU and legs allow, by the stamp of the scan.
std::map<Time, double> leg_bounds(const RunResult& result) {
  const auto bounds = bounds_without_lidar(result.truth, result.localizability);
  std::map<Time, double> by_stamp;
  for (std::size_t i = 0; i < bounds.size(); ++i) {
    const Localizability& scan = result.localizability.scans[i];
    by_stamp[scan.stamp] = bound_along(bounds[i], scan.weak_axis_in_world);
  }
  return by_stamp;
}

Json series_json(const std::vector<WeakAxisError>& errors, const std::map<Time, double>& legs,
                 Time start) {
  Json json = {{"t_s", Json::array()},
               {"error_m", Json::array()},
               {"sigma_m", Json::array()},
               {"bound_m", Json::array()},
               {"leg_bound_m", Json::array()}};
  Time next = start;
  for (const WeakAxisError& each : errors) {
    if (each.stamp < next) continue;
    const auto second =
        static_cast<std::int64_t>((each.stamp - start) / (kSeriesSpacing * kSecond));
    next = start + (second + 1) * kSeriesSpacing * kSecond;
    json["t_s"].push_back(second * kSeriesSpacing);
    json["error_m"].push_back(each.error_m);
    const bool stated = each.variance && *each.variance > 0.0;
    json["sigma_m"].push_back(stated ? json_of(std::sqrt(*each.variance)) : Json());
    json["bound_m"].push_back(json_of(each.bound_m));
    const auto leg = legs.find(each.stamp);
    json["leg_bound_m"].push_back(leg == legs.end() ? Json() : json_of(leg->second));
  }
  return json;
}

double number_in(const Json& json) { return json.is_number() ? json.get<double>() : 0.0; }

}  // namespace

void add_weak_axis_series(const RunResult& result, RunRecord& record) {
  if (result.truth_trajectory.empty()) return;
  const auto legs = leg_bounds(result);
  for (const EstimatorOutcome& outcome : result.estimators) {
    record.scores[kGroup][outcome.name] =
        series_json(outcome.weak_axis_errors, legs, result.truth_trajectory.front().stamp);
  }
}

bool holds_series(const RunRecord& record, const std::string& label) {
  return record.scores.contains(kGroup) && record.scores[kGroup].contains(label);
}

ConsistencyRun series_of(const RunRecord& record, const std::string& label) {
  ConsistencyRun run;
  if (!holds_series(record, label)) return run;
  const Json& series = record.scores[kGroup][label];
  for (std::size_t i = 0; i < series.at("t_s").size(); ++i) {
    const Json& sigma = series.at("sigma_m")[i];
    run.push_back({number_in(series.at("t_s")[i]), number_in(series.at("error_m")[i]),
                   sigma.is_number() ? std::optional(sigma.get<double>()) : std::nullopt,
                   number_in(series.at("bound_m")[i]), number_in(series.at("leg_bound_m")[i])});
  }
  return run;
}

}  // namespace aims
