// SPDX-License-Identifier: BSD-3-Clause
#include "bench/tuning/point_table.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <vector>

#include "bench/metrics/statistics.hpp"
#include "bench/scoring/score_record.hpp"
#include "bench/tuning/analysis.hpp"
#include "bench/tuning/response_summary.hpp"

namespace aims {
namespace {

/// One point over the sequences of its table.
struct PointSummary {
  std::vector<double> values;
  std::optional<double> objective;
  std::optional<double> median;  ///< of the score
  std::optional<double> worst;   ///< likewise
  std::size_t diverged = 0;
  std::size_t runs = 0;
};

PointSummary summary_of(const ResponseTable& table, const Objective& objective, std::size_t point) {
  const bool of_defaults = point == kDefaults;
  const std::span<const RunScore> runs = of_defaults ? table.default_runs : table.runs[point];
  PointSummary summary;
  summary.values = of_defaults ? table.defaults : table.points[point];
  std::vector<double> scores;
  for (const RunScore& run : runs) {
    if (run.value) scores.push_back(*run.value);
    if (run.diverged) ++summary.diverged;
  }
  summary.objective = objective_at(table, objective, point, cases_of(table, ""));
  summary.median = median(scores);
  if (!scores.empty()) summary.worst = *std::max_element(scores.begin(), scores.end());
  summary.runs = runs.size();
  return summary;
}

std::vector<std::string> row_of(const std::string& name, const PointSummary& point, bool is_best) {
  std::vector<std::string> row = {name};
  for (const double value : point.values) row.push_back(fmt::format("{:g}", value));
  row.push_back(figure_text(point.objective) + (is_best ? " best" : ""));
  row.push_back(figure_text(point.median));
  row.push_back(figure_text(point.worst));
  row.push_back(fmt::format("{} of {}", point.diverged, point.runs));
  return row;
}

Json point_json(const ResponseTable& table, const PointSummary& point) {
  Json values = Json::object();
  for (std::size_t i = 0; i < point.values.size(); ++i) {
    values[table.ranges[i].key] = point.values[i];
  }
  return {{"values", std::move(values)},
          {"objective", json_of(point.objective)},
          {"score_median", json_of(point.median)},
          {"score_worst", json_of(point.worst)},
          {"diverged", point.diverged},
          {"runs", point.runs}};
}

}  // namespace

TextTable point_table(std::span<const SweepResponse> responses, const Objective& objective) {
  TextTable text;
  if (responses.empty()) return text;
  text.header = {"estimator"};
  for (const ParameterRange& range : responses.front().table.ranges) {
    text.header.push_back(range.key);
  }
  text.header.insert(text.header.end(), {"objective", "score (" + objective.score + "), median",
                                         "largest", "diverged"});
  for (const SweepResponse& response : responses) {
    const ResponseTable& table = response.table;
    const Objective own = objective_for(objective, table);
    const auto best = best_point(table, own);
    if (!table.default_runs.empty()) {
      text.rows.push_back(
          row_of(response.estimator + " (default)", summary_of(table, own, kDefaults), false));
    }
    for (std::size_t k = 0; k < table.points.size(); ++k) {
      text.rows.push_back(
          row_of(response.estimator, summary_of(table, own, k), best && best->point == k));
    }
  }
  return text;
}

Json response_json(const SweepResponse& response, const Objective& objective) {
  const ResponseTable& table = response.table;
  const Objective own = objective_for(objective, table);
  const auto best = best_point(table, own);
  Json points = Json::array();
  if (!table.default_runs.empty()) {
    points.push_back(point_json(table, summary_of(table, own, kDefaults)));
    points.back().update({{"default", true}, {"best", false}});
  }
  for (std::size_t k = 0; k < table.points.size(); ++k) {
    points.push_back(point_json(table, summary_of(table, own, k)));
    points.back().update({{"default", false}, {"best", best && best->point == k}});
  }
  return {{"estimator", response.estimator},
          {"objective", text_of(own)},
          {"incomplete", response.incomplete},
          {"points", std::move(points)}};
}

}  // namespace aims
