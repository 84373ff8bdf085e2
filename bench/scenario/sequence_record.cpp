// SPDX-License-Identifier: BSD-3-Clause
#include "bench/scenario/sequence_record.hpp"

#include <algorithm>
#include <utility>

#include "bench/metrics/statistics.hpp"
#include "bench/scoring/validity.hpp"

namespace aims {
namespace {

/// What the scans constrain, whoever estimates.
Json localizability_json(std::span<const Localizability> scans,
                         std::span<const PosteriorBound> bounds) {
  std::vector<double> returns;
  for (const Localizability& scan : scans) returns.push_back(scan.equivalent_returns);
  Json fraction = Json::object();
  for (const DegeneracyLevel& level : kDegeneracyLevels) {
    const auto degenerate =
        std::count_if(scans.begin(), scans.end(),
                      [&level](const Localizability& scan) { return is_degenerate(scan, level); });
    fraction[std::string(level.name)] =
        scans.empty() ? Json()
                      : Json(static_cast<double>(degenerate) / static_cast<double>(scans.size()));
  }
  Json bound;
  if (!bounds.empty()) {
    const PosteriorBound& end = bounds.back();
    bound = {{"longitudinal", json_of(end.longitudinal)},
             {"lateral", json_of(end.lateral)},
             {"vertical", json_of(end.vertical)}};
  }
  return {{"scans", scans.size()},
          {"median_equivalent_returns", json_of(median(returns))},
          {"degenerate_fraction", std::move(fraction)},
          {"bound_end_m", std::move(bound)}};
}

}  // namespace

Json robot_json(const WalkOutcome& walk) {
  return {{"fell", walk.end == WalkEnd::kFell},
          {"end", name_of(walk.end)},
          {"touched_wall", walk.touched_wall},
          {"wall_contact_fraction", walk.wall_contact_fraction}};
}

Json sequence_json(double simulated_s, const WalkOutcome& walk, const Scores& scores,
                   std::span<const Localizability> scans, std::span<const PosteriorBound> bounds) {
  Json json = {{"simulated_s", simulated_s},
               {"robot", robot_json(walk)},
               {"segments", segments_json(scores)},
               {"localizability", localizability_json(scans, bounds)}};
  mark_validity(json);
  return json;
}

Json drawn_json(const std::vector<DrawnValue>& drawn) {
  Json json = Json::object();
  for (const DrawnValue& each : drawn) {
    const Json value = Json::parse(each.value, nullptr, false);
    json[each.key] = value.is_number() || value.is_boolean() ? value : Json(each.value);
  }
  return json;
}

}  // namespace aims
