// SPDX-License-Identifier: BSD-3-Clause
#include "bench/tuning/sensitivity.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

namespace aims {
namespace {

constexpr double kNegligibleIndex = 0.05;
constexpr int kReplicates = 200;

/// The points that have an objective over some cases.
struct Response {
  Eigen::MatrixXd points;  ///< a row of fractions each
  Eigen::VectorXd values;
  bool logarithmic = true;
};

Response response_over(const ResponseTable& table, const Objective& objective,
                       std::span<const std::size_t> cases) {
  std::vector<double> values;
  std::vector<Eigen::VectorXd> rows;
  for (std::size_t k = 0; k < table.points.size(); ++k) {
    const auto value = objective_at(table, objective, k, cases);
    if (!value || !is_inside(table, table.points[k])) continue;
    values.push_back(*value);
    rows.push_back(fractions_of(table, table.points[k]));
  }
  Response response;
  response.logarithmic =
      std::all_of(values.begin(), values.end(), [](double value) { return value > 0.0; });
  response.points.resize(static_cast<Eigen::Index>(rows.size()),
                         static_cast<Eigen::Index>(table.ranges.size()));
  response.values.resize(static_cast<Eigen::Index>(rows.size()));
  for (std::size_t k = 0; k < rows.size(); ++k) {
    const auto row = static_cast<Eigen::Index>(k);
    response.points.row(row) = rows[k].transpose();
    response.values(row) = response.logarithmic ? std::log(values[k]) : values[k];
  }
  return response;
}

/// Of the total indices of a grid, over seeds drawn again.
std::vector<Interval> intervals_over_seeds(const ResponseTable& table, const Objective& objective,
                                           const std::string& family) {
  const SeedGroups seeds = cases_by_seed(table, cases_of(table, family));
  std::map<std::vector<std::size_t>, std::optional<SobolIndices>> known;
  std::vector<Interval> intervals;
  for (std::size_t i = 0; i < table.ranges.size(); ++i) {
    const auto total = [&](std::span<const std::size_t> drawn) -> std::optional<double> {
      std::vector<std::size_t> sorted(drawn.begin(), drawn.end());
      std::sort(sorted.begin(), sorted.end());
      auto found = known.find(sorted);
      if (found == known.end()) {
        const Response some = response_over(table, objective, joined(seeds, sorted));
        found = known.emplace(std::move(sorted), grid_indices(some.points, some.values)).first;
      }
      return found->second ? std::optional<double>(found->second->total[i]) : std::nullopt;
    };
    intervals.push_back(bootstrap_interval(seeds.size(), total, 1, kReplicates));
  }
  return intervals;
}

}  // namespace

std::string why_no_indices_of_one(const Effect& effect) {
  return effect.is_resolved() ? "one parameter was varied, whose index is 100 % by definition"
                              : "one parameter was varied, without an effect that is resolved";
}

bool Sensitivity::is_negligible(std::size_t parameter) const {
  if (!is_resolved()) return false;
  return indices.total[parameter] < kNegligibleIndex &&
         indices.total_interval[parameter].high.value_or(1.0) < kNegligibleIndex;
}

Result<Sensitivity> sensitivity_of(const ResponseTable& table, const Objective& objective,
                                   const std::string& family) {
  if (objective.divergence_penalty > 0.0 && all_diverged(table)) {
    return failure("every run diverged or failed");
  }
  const Response response = response_over(table, objective, cases_of(table, family));
  Sensitivity sensitivity;
  sensitivity.points = static_cast<std::size_t>(response.values.size());
  sensitivity.logarithmic = response.logarithmic;
  sensitivity.effect = effect_of(table, objective, family);
  auto surrogate = Surrogate::fit(response.points, response.values);
  auto of_grid = grid_indices(response.points, response.values);
  auto of_part = of_grid ? std::nullopt : fractional_indices(response.points, response.values);
  if (of_part && of_part->explained < kLeastExplained) of_part.reset();
  if (!surrogate && !of_grid && !of_part) return tl::unexpected(surrogate.error());
  if (surrogate) sensitivity.surrogate = std::move(*surrogate);
  sensitivity.of_grid = of_grid.has_value();
  if (of_grid) {
    sensitivity.indices = std::move(*of_grid);
    sensitivity.indices.total_interval = intervals_over_seeds(table, objective, family);
  } else if (of_part) {
    sensitivity.indices = of_part->indices;
    sensitivity.of_part = std::move(of_part);
  } else {
    sensitivity.indices = sensitivity.surrogate->indices();
  }
  return sensitivity;
}

Eigen::VectorXd fractions_of(const ResponseTable& table, const std::vector<double>& values) {
  Eigen::VectorXd fractions(static_cast<Eigen::Index>(values.size()));
  for (std::size_t i = 0; i < values.size(); ++i) {
    fractions(static_cast<Eigen::Index>(i)) =
        std::clamp(fraction_of(table.ranges[i], values[i]), 0.0, 1.0);
  }
  return fractions;
}

}  // namespace aims
