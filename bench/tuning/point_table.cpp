// SPDX-License-Identifier: BSD-3-Clause
#include "bench/tuning/point_table.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <numeric>
#include <optional>
#include <tuple>
#include <vector>

#include "bench/metrics/statistics.hpp"
#include "bench/scoring/report.hpp"
#include "bench/scoring/score_statistics.hpp"
#include "bench/tuning/analysis.hpp"
#include "bench/tuning/effect.hpp"
#include "bench/tuning/response_summary.hpp"

namespace aims {
namespace {

/// One point over the sequences of its table.
struct PointSummary {
  std::string name;  ///< of the estimator
  bool is_default = false;
  bool is_best = false;
  bool is_resolved = false;  ///< points differ by more than seeds scatter
  std::string best_mark;     ///< of the best one: " best", unless points are not resolved
  std::vector<double> values;
  std::optional<double> objective;
  std::optional<double> median;  ///< of the score
  std::optional<double> worst;   ///< likewise
  std::size_t diverged = 0;
  std::size_t runs = 0;  ///< that are valid
};

PointSummary summary_of(const ResponseTable& table, const Objective& objective, std::size_t point) {
  const bool of_defaults = point == kDefaults;
  const std::vector<RunScore>& runs = runs_at(table, point);
  PointSummary summary;
  summary.is_default = of_defaults;
  summary.values = values_at(table, point);
  std::vector<double> scores;
  const auto cases = cases_of(table, "");
  for (const std::size_t i : cases) {
    const RunScore& run = runs[i];
    if (run.value) scores.push_back(*run.value);
    if (run.diverged) ++summary.diverged;
    if (run.invalid.empty()) ++summary.runs;
  }
  summary.objective = objective_at(table, objective, point, cases);
  summary.median = median(scores);
  summary.worst = worst_of(scores, objective.score);
  return summary;
}

/// The default values, where they were run, then the other points.
std::vector<PointSummary> summaries_of(const SweepResponse& response, const Objective& objective) {
  const ResponseTable& table = response.table;
  const auto best = best_point(table, objective);
  const Effect effect = effect_of(table, objective);
  const std::string_view standing = best ? name_of(standing_of(*best, effect)) : "";
  std::vector<PointSummary> summaries;
  const auto add = [&](std::size_t point) {
    summaries.push_back(summary_of(table, objective, point));
    summaries.back().is_best = best && best->point == point;
    summaries.back().is_resolved = best && is_resolved(*best, effect);
    summaries.back().best_mark = fmt::format(" {}", standing);
  };
  if (!table.default_runs.empty()) add(kDefaults);
  for (std::size_t k = 0; k < table.points.size(); ++k) {
    if (table.default_runs.empty() || table.points[k] != table.defaults) add(k);
  }
  for (PointSummary& each : summaries) {
    each.name = response.estimator + (each.is_default ? " (default)" : "");
  }
  return summaries;
}

/// The defaults, the best point and those of least objective, at most `most`, in their order.
std::vector<PointSummary> best_of(const std::vector<PointSummary>& points, std::size_t most) {
  const auto rank = [](const PointSummary& point) {
    return std::tuple(!point.is_default && !point.is_best, !point.objective,
                      point.objective.value_or(0.0));
  };
  std::vector<std::size_t> order(points.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::ranges::stable_sort(order, {}, [&](std::size_t k) { return rank(points[k]); });
  order.resize(std::min(most, order.size()));
  std::ranges::sort(order);
  std::vector<PointSummary> kept;
  for (const std::size_t k : order) kept.push_back(points[k]);
  return kept;
}

TableColumns<PointSummary> point_columns(const std::vector<ParameterRange>& ranges,
                                         const std::string& score) {
  using Point = PointSummary;
  TableColumns<Point> columns = {{"", "estimator", &Point::name}};
  for (std::size_t i = 0; i < ranges.size(); ++i) {
    columns.push_back(
        {"", ranges[i].key, [i](const Point& point) { return point.values[i]; }, "{:g}"});
  }
  const TableColumns<Point> figures = {
      {"values", "",
       [ranges](const Point& point) {
         Json values = Json::object();
         for (std::size_t i = 0; i < ranges.size(); ++i) values[ranges[i].key] = point.values[i];
         return values;
       }},
      {"objective", "", &Point::objective},
      {"", "objective",
       [](const Point& point) {
         return figure_text(point.objective) + (point.is_best ? point.best_mark : "");
       }},
      {"score_median", "score (" + score + "), median", &Point::median, "{:.3g}"},
      {"score_worst", "worst", &Point::worst, "{:.3g}"},
      {"diverged", "", &Point::diverged},
      {"runs", "", &Point::runs},
      {"", "diverged",
       [](const Point& point) { return fmt::format("{} of {}", point.diverged, point.runs); }},
      {"default", "", &Point::is_default},
      {"best", "", &Point::is_best},
      {"resolved", "", &Point::is_resolved}};
  columns.insert(columns.end(), figures.begin(), figures.end());
  return columns;
}

}  // namespace

TextTable point_table(std::span<const SweepResponse> responses, const Objective& objective,
                      std::size_t most) {
  if (responses.empty()) return {};
  std::vector<PointSummary> points;
  for (const SweepResponse& response : responses) {
    std::ranges::move(
        best_of(summaries_of(response, objective_for(objective, response.table)), most),
        std::back_inserter(points));
  }
  return rows_table(point_columns(responses.front().table.ranges, objective.score), points);
}

Json response_json(const SweepResponse& response, const Objective& objective) {
  const Objective own = objective_for(objective, response.table);
  return {{"estimator", response.estimator},
          {"objective", text_of(own)},
          {"incomplete", response.incomplete},
          {"points", rows_json(point_columns(response.table.ranges, own.score),
                               summaries_of(response, own))}};
}

}  // namespace aims
