// SPDX-License-Identifier: BSD-3-Clause
#include "render/page/tuning_analyses.hpp"

#include <algorithm>
#include <limits>
#include <map>
#include <numeric>
#include <optional>
#include <utility>

#include "bench/scoring/score_statistics.hpp"
#include "bench/tuning/held_out.hpp"
#include "bench/tuning/sweep_summary.hpp"
#include "render/page/tuning_analysis.hpp"

namespace aims {
namespace {

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
