// SPDX-License-Identifier: BSD-3-Clause
#include "bench/tuning/point_table.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <vector>

#include "bench/metrics/statistics.hpp"
#include "bench/tuning/analysis.hpp"
#include "bench/tuning/response_summary.hpp"

namespace aims {
namespace {

std::vector<std::string> row_of(const std::string& name, const ResponseTable& table,
                                const Objective& objective, std::size_t point, bool is_best) {
  const bool of_defaults = point == kDefaults;
  const std::span<const RunScore> runs = of_defaults ? table.default_runs : table.runs[point];
  std::vector<std::string> row = {name};
  for (const double value : of_defaults ? table.defaults : table.points[point]) {
    row.push_back(fmt::format("{:g}", value));
  }
  std::vector<double> scores;
  for (const RunScore& run : runs) {
    if (run.value) scores.push_back(*run.value);
  }
  const auto diverged =
      std::count_if(runs.begin(), runs.end(), [](const RunScore& run) { return run.diverged; });
  std::optional<double> worst;
  if (!scores.empty()) worst = *std::max_element(scores.begin(), scores.end());
  row.push_back(figure_text(objective_at(table, objective, point, cases_of(table, ""))) +
                (is_best ? " best" : ""));
  row.push_back(figure_text(median(scores)));
  row.push_back(figure_text(worst));
  row.push_back(fmt::format("{} of {}", diverged, runs.size()));
  return row;
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
      text.rows.push_back(row_of(response.estimator + " (default)", table, own, kDefaults, false));
    }
    for (std::size_t k = 0; k < table.points.size(); ++k) {
      text.rows.push_back(row_of(response.estimator, table, own, k, best && best->point == k));
    }
  }
  return text;
}

}  // namespace aims
