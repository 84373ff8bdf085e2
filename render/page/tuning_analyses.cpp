// SPDX-License-Identifier: BSD-3-Clause
#include "render/page/tuning_analyses.hpp"

#include <algorithm>
#include <limits>
#include <map>
#include <numeric>
#include <optional>
#include <utility>

#include "bench/scoring/report.hpp"
#include "bench/scoring/score_record.hpp"
#include "bench/scoring/score_statistics.hpp"
#include "bench/tuning/analysis.hpp"
#include "bench/tuning/effect.hpp"
#include "bench/tuning/held_out.hpp"
#include "bench/tuning/objective.hpp"
#include "bench/tuning/sensitivity.hpp"
#include "bench/tuning/slice.hpp"
#include "bench/tuning/sweep_summary.hpp"

namespace aims {
namespace {

constexpr std::size_t kMostFamilies = 12;     ///< with a curve of their own
constexpr std::size_t kMostMaps = 28;         ///< pairs of parameters
constexpr std::size_t kMostFamilyMaps = 112;  ///< pairs and families

Json best_json(const ResponseTable& table, const BestPoint& best) {
  return {{"values", best.values},
          {"is_default", best.is_default()},
          {"text", text_of(best, table)},
          {"between", json_array(best.between, interval_json)},
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
  for (const auto& row : indices.second.rowwise()) {
    second.push_back(std::vector<double>(row.begin(), row.end()));
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
               {"total_interval", json_array(indices.total_interval, interval_json)},
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

/// What the held-out sequences say of a point.
Json held_out_json(const PairedGain& gain) {
  return {{"verdict", name_of(verdict_of(gain))},
          {"text", verdict_text(gain)},
          {"sequences", gain.sequences},
          {"gain", json_of(gain.gain)},
          {"gain_interval", interval_json(gain.interval)},
          {"p", gain.p}};
}

/// Results of `aims merge` and `aims tune` for one estimator and one objective, as a page holds
/// them: best point with its intervals, sensitivity, the curve along every parameter over all
/// scenarios and of every family, and the map over every pair of parameters. Parts that the points
/// do not yield are null and give the reason. Curves and maps are arrays of `page`.
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
  json["standing"] = name_of(standing_of(*best, effect));
  json["unresolved"] = unresolved_text(*best, effect);
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

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

/// The objectives that are analysed: those of the plan, then the first one of each headline score.
std::vector<Objective> analysed(const TuningSource& source) {
  std::vector<Objective> objectives = source.objectives;
  for (const Score& score : headline_scores()) {
    const bool known = std::any_of(objectives.begin(), objectives.end(),
                                   [&](const auto& each) { return each.score == score.key; });
    if (known) continue;
    Objective objective = source.objectives.front();
    objective.score = score.key;
    objectives.push_back(objective);
  }
  return objectives;
}

/// The table as the tuning has it: the untuned values are its first point (and one job with it),
/// the others stand in the order of the search where that is known.
ResponseTable in_tuning_order(const ResponseTable& table, const TuningSource& source) {
  ResponseTable ordered = table;
  const auto& points = table.points;
  if (!table.default_runs.empty() &&
      std::find(points.begin(), points.end(), table.defaults) == points.end()) {
    ordered.points.insert(ordered.points.begin(), table.defaults);
    ordered.runs.insert(ordered.runs.begin(), table.default_runs);
  }
  const auto place = [&](std::size_t i) {
    const auto found = source.points.find(ordered.points[i]);
    return found == source.points.end() ? source.points.size() : found->second.index;
  };
  std::vector<std::size_t> order(ordered.points.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return place(a) < place(b); });
  ResponseTable sorted = ordered;
  for (std::size_t i = 0; i < order.size(); ++i) {
    sorted.points[i] = ordered.points[order[i]];
    sorted.runs[i] = ordered.runs[order[i]];
  }
  return sorted;
}

/// The estimator's points in one score; none when it has no runs.
Result<std::optional<SweepResponse>> response_of(const MergedSweep& units,
                                                 const std::string& estimator,
                                                 const std::string& score) {
  auto responses = sweep_responses(units, score);
  if (!responses) return tl::unexpected(responses.error());
  for (SweepResponse& each : *responses) {
    if (each.estimator == estimator) return std::optional(std::move(each));
  }
  return std::optional<SweepResponse>();
}

/// What the held-out sequences say of the point; none when it was not run on them.
Result<std::optional<PairedGain>> held_out_of(const TuningSource& source,
                                              const std::string& estimator,
                                              const Objective& objective,
                                              const std::vector<double>& values) {
  const auto held = response_of(source.held_out, estimator, objective.score);
  if (!held) return tl::unexpected(held.error());
  if (!*held) return std::optional<PairedGain>();
  const ResponseTable table = in_tuning_order((*held)->table, source);
  const auto found = std::find(table.points.begin(), table.points.end(), values);
  if (found == table.points.end()) return std::optional<PairedGain>();
  const auto point = static_cast<std::size_t>(found - table.points.begin());
  return std::optional(paired_gain(table, objective, point));
}

/// The objective of each of the estimator's points, in their order.
Json objectives_json(const PagePoints& points, const ResponseTable& table,
                     const Objective& objective, PageData& page) {
  const auto all = cases_of(table, "");
  std::map<std::vector<double>, double> known;
  for (std::size_t k = 0; k < table.points.size(); ++k) {
    known[table.points[k]] = objective_at(table, objective, k, all).value_or(kNone);
  }
  std::vector<double> values;
  for (const auto& point : points) {
    const auto found = known.find(point);
    values.push_back(point.empty() ? objective_at(table, objective, kDefaults, all).value_or(kNone)
                     : found == known.end() ? kNone
                                            : found->second);
  }
  return page.f32(values);
}

}  // namespace

Result<Json> analyses_json(const TuningSource& source, const std::string& estimator,
                           const PagePoints& points, PageData& page) {
  Json analyses = Json::array();
  for (const Objective& objective : analysed(source)) {
    const auto response = response_of(source.units, estimator, objective.score);
    if (!response) return tl::unexpected(response.error());
    if (!*response) continue;
    const ResponseTable table =
        source.tuned ? in_tuning_order((*response)->table, source) : (*response)->table;
    const Objective used = objective_for(objective, table);
    Json analysis = analysis_json(table, used, page);
    analysis["incomplete"] = (*response)->incomplete;
    analysis["objectives"] = objectives_json(points, table, used, page);
    if (source.tuned && !analysis["best"].is_null()) {
      const auto values = analysis["best"]["values"].get<std::vector<double>>();
      const auto held = held_out_of(source, estimator, objective, values);
      if (!held) return tl::unexpected(held.error());
      if (*held || (source.held_out.jobs.empty() && !source.holds_out)) {
        analysis["held_out"] = held_out_json(held->value_or(PairedGain{}));
      }
    }
    analyses.push_back(std::move(analysis));
  }
  return analyses;
}

}  // namespace aims
