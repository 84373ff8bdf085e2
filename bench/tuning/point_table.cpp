// SPDX-License-Identifier: BSD-3-Clause
#include "bench/tuning/point_table.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <vector>

#include "bench/metrics/statistics.hpp"
#include "bench/tuning/response_summary.hpp"

namespace aims {
namespace {

std::vector<std::string> row_of(const std::string& estimator, const std::vector<double>& values,
                                std::span<const RunScore> runs) {
  std::vector<std::string> row = {estimator};
  for (const double value : values) row.push_back(fmt::format("{:g}", value));
  std::vector<double> scores;
  for (const RunScore& run : runs) {
    if (run.value) scores.push_back(*run.value);
  }
  const auto diverged =
      std::count_if(runs.begin(), runs.end(), [](const RunScore& run) { return run.diverged; });
  std::optional<double> worst;
  if (!scores.empty()) worst = *std::max_element(scores.begin(), scores.end());
  row.push_back(figure_text(median(scores)));
  row.push_back(figure_text(worst));
  row.push_back(fmt::format("{} of {}", diverged, runs.size()));
  return row;
}

}  // namespace

TextTable point_table(std::span<const SweepResponse> responses, const std::string& score) {
  TextTable table;
  if (responses.empty()) return table;
  table.header = {"estimator"};
  for (const ParameterRange& range : responses.front().table.ranges) {
    table.header.push_back(range.key);
  }
  table.header.insert(table.header.end(), {score + ", median", "largest", "diverged"});
  for (const SweepResponse& response : responses) {
    const ResponseTable& points = response.table;
    if (!points.default_runs.empty()) {
      const std::string name = response.estimator + " (default)";
      table.rows.push_back(row_of(name, points.defaults, points.default_runs));
    }
    for (std::size_t i = 0; i < points.points.size(); ++i) {
      table.rows.push_back(row_of(response.estimator, points.points[i], points.runs[i]));
    }
  }
  return table;
}

}  // namespace aims
