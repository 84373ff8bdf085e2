// SPDX-License-Identifier: BSD-3-Clause
#include "render/page/tuning_analysis.hpp"

#include <limits>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "bench/tuning/analysis.hpp"
#include "bench/tuning/effect.hpp"
#include "bench/tuning/held_out.hpp"
#include "bench/tuning/sensitivity.hpp"
#include "bench/tuning/slice.hpp"

namespace aims {
namespace {

constexpr std::size_t kMostFamilies = 12;     ///< with a curve of their own
constexpr std::size_t kMostMaps = 28;         ///< pairs of parameters
constexpr std::size_t kMostFamilyMaps = 112;  ///< pairs and families

Json interval_json(const Interval& interval) {
  return Json::array({json_of(interval.low), json_of(interval.high)});
}

Json intervals_json(const std::vector<Interval>& intervals) {
  Json json = Json::array();
  for (const Interval& each : intervals) json.push_back(interval_json(each));
  return json;
}

Json best_json(const ResponseTable& table, const BestPoint& best) {
  return {{"values", best.values},
          {"is_default", best.is_default()},
          {"text", text_of(best, table)},
          {"between", intervals_json(best.between)},
          {"without_effect", best.without_effect},
          {"objective", json_of(best.objective)},
          {"objective_interval", interval_json(best.objective_interval)},
          {"defaults", json_of(best.defaults)},
          {"gain", json_of(best.gain)},
          {"defaults_diverged", best.defaults_diverged},
          {"gain_interval", interval_json(best.gain_interval)},
          {"distance", best.distance}};
}

Json sensitivity_json(const Sensitivity& sensitivity, std::size_t parameters) {
  const SobolIndices& indices = sensitivity.indices;
  Json second = Json::array();
  for (Eigen::Index i = 0; i < indices.second.rows(); ++i) {
    Json row = Json::array();
    for (Eigen::Index k = 0; k < indices.second.cols(); ++k) row.push_back(indices.second(i, k));
    second.push_back(std::move(row));
  }
  Json negligible = Json::array();
  for (std::size_t i = 0; i < parameters; ++i) negligible.push_back(sensitivity.is_negligible(i));
  Json json = {{"points", sensitivity.points},
               {"has_indices", sensitivity.has_indices()},
               {"logarithmic", sensitivity.logarithmic},
               {"of_grid", sensitivity.of_grid},
               {"resolved", sensitivity.is_resolved()},
               {"least_explained", kLeastExplained},
               {"fit", nullptr},
               {"first", indices.first},
               {"total", indices.total},
               {"total_interval", intervals_json(indices.total_interval)},
               {"second", std::move(second)},
               {"negligible", std::move(negligible)}};
  if (sensitivity.of_part) {
    json["of_part"] = {{"explained", sensitivity.of_part->explained},
                       {"with_pairs", sensitivity.of_part->with_pairs}};
  }
  if (sensitivity.surrogate) {
    json["fit"] = {{"terms", sensitivity.surrogate->terms()},
                   {"error", sensitivity.surrogate->error()},
                   {"explained", sensitivity.surrogate->explained()}};
  }
  return json;
}

/// Null for none.
Json points_json(const std::vector<SlicePoint>& points, bool has_y, PageData& page) {
  if (points.empty()) return {};
  constexpr double kNoValue = std::numeric_limits<double>::quiet_NaN();
  std::vector<double> x, y, value, low, high;
  for (const SlicePoint& point : points) {
    x.push_back(point.x);
    y.push_back(point.y);
    value.push_back(point.objective.value_or(kNoValue));
    low.push_back(point.interval.low.value_or(kNoValue));
    high.push_back(point.interval.high.value_or(kNoValue));
  }
  Json json = {{"x", page.f32(x)}, {"value", page.f32(value)}};
  if (has_y) json["y"] = page.f32(y);
  json["low"] = page.f32(low);
  json["high"] = page.f32(high);
  return json;
}

/// The family, or its scenario where there is one alone; empty for all sequences.
std::string group_name(const ResponseTable& table, const std::string& family) {
  std::string name;
  for (const std::size_t i : cases_of(table, family)) {
    const std::string& scenario = table.cases[i].scenario;
    if (!name.empty() && name != scenario) return family;
    name = scenario;
  }
  return family.empty() ? family : name;
}

/// Null for an empty slice.
Json slice_json(const ResponseTable& table, const Slice& slice, PageData& page) {
  if (slice.is_empty()) return {};
  const bool has_y = slice.second.has_value();
  Json json = {{"first", slice.first},
               {"family", group_name(table, slice.family)},
               {"held", held_text(table, slice)},
               {"held_at", slice.held},
               {"measured", points_json(slice.measured, has_y, page)},
               {"fit", points_json(slice.fit, has_y, page)}};
  if (has_y) json["second"] = *slice.second;
  return json;
}

/// All sequences (""), then the families where there are several, but not too many.
std::vector<std::string> groups_of(const ResponseTable& table) {
  std::vector<std::string> families = families_of(table);
  if (families.size() == 1 || families.size() > kMostFamilies) families.clear();
  families.insert(families.begin(), "");
  return families;
}

Json curves_json(const ResponseTable& table, const Objective& objective, PageData& page) {
  const std::vector<std::string> families = groups_of(table);
  Json curves = Json::array();
  for (std::size_t i = 0; i < table.ranges.size(); ++i) {
    for (const std::string& family : families) {
      Json curve = slice_json(table, curve_of(table, objective, i, family), page);
      if (!curve.is_null()) curves.push_back(std::move(curve));
    }
  }
  return curves;
}

Json maps_json(const ResponseTable& table, const Objective& objective, PageData& page) {
  Json maps = Json::array();
  const std::size_t count = table.ranges.size();
  const std::size_t pairs = count * (count - 1) / 2;
  if (pairs > kMostMaps) return maps;
  std::vector<std::string> groups = groups_of(table);
  if (pairs * groups.size() > kMostFamilyMaps) groups = {""};
  for (std::size_t i = 0; i < count; ++i) {
    for (std::size_t k = i + 1; k < count; ++k) {
      for (const std::string& group : groups) {
        Json map = slice_json(table, map_of(table, objective, i, k, group), page);
        if (!map.is_null()) maps.push_back(std::move(map));
      }
    }
  }
  return maps;
}

const char* name_of(Verdict verdict) {
  if (verdict == Verdict::kUseThem) return "use";
  return verdict == Verdict::kDoNotUse ? "do not use" : "undecided";
}

}  // namespace

Json held_out_json(const PairedGain& gain) {
  return {{"verdict", name_of(verdict_of(gain))},
          {"text", verdict_text(gain)},
          {"sequences", gain.sequences},
          {"gain", json_of(gain.gain)},
          {"gain_interval", interval_json(gain.interval)},
          {"p", gain.p}};
}

Json analysis_json(const ResponseTable& table, const Objective& objective, PageData& page) {
  Json json = {{"score", objective.score},
               {"objective", text_of(objective)},
               {"axis", axis_label(objective)},
               {"relative", objective.relative},
               {"points", table.points.size()},
               {"seeds", seeds_of(table).size()},
               {"best", nullptr},
               {"held_out", nullptr},
               {"sensitivity", nullptr},
               {"curves", Json::array()},
               {"maps", Json::array()}};
  const auto best = best_point(table, objective);
  if (!best) {
    json["why_no_best"] = best.error().message;
    return json;
  }
  json["best"] = best_json(table, *best);
  const Effect effect = effect_of(table, objective);
  json["effect"] = text_of(effect);
  json["standing"] = standing_of(*best, effect);
  const auto sensitivity = sensitivity_of(table, objective);
  if (table.ranges.size() == 1) {
    json["why_no_sensitivity"] = why_no_indices_of_one(effect);
  } else if (sensitivity) {
    json["sensitivity"] = sensitivity_json(*sensitivity, table.ranges.size());
  } else {
    json["why_no_sensitivity"] = sensitivity.error().message;
  }
  json["curves"] = curves_json(table, objective, page);
  json["maps"] = maps_json(table, objective, page);
  return json;
}

}  // namespace aims
