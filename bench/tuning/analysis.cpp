// SPDX-License-Identifier: BSD-3-Clause
#include "bench/tuning/analysis.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <utility>

namespace aims {
namespace {

constexpr std::uint64_t kBootstrapSeed = 1;

/// The point with the least objective over the cases; none when none has one.
std::optional<std::size_t> least(const ResponseTable& table, const Objective& objective,
                                 std::span<const std::size_t> cases) {
  std::optional<std::size_t> best;
  double least_value = 0.0;
  for (std::size_t k = 0; k < table.points.size(); ++k) {
    const auto value = objective_at(table, objective, k, cases);
    if (!value || (best && *value >= least_value)) continue;
    best = k;
    least_value = *value;
  }
  return best;
}

/// Fills the intervals of `best`.
void add_intervals(const ResponseTable& table, const Objective& objective, BestPoint& best) {
  const auto seeds = seeds_of(table);
  const auto cases = [&](std::span<const std::size_t> drawn) {
    return cases_of_seeds(table, "", seeds, drawn);
  };
  const auto interval = [&](const ClusterStatistic& statistic) {
    return bootstrap_interval(seeds.size(), statistic, kBootstrapSeed);
  };
  best.objective_interval = interval([&](std::span<const std::size_t> drawn) {
    return objective_at(table, objective, best.point, cases(drawn));
  });
  if (best.gain)
    best.gain_interval = interval([&](std::span<const std::size_t> drawn) {
      const auto some = cases(drawn);
      return gain_over(objective_at(table, objective, kDefaults, some),
                       objective_at(table, objective, best.point, some));
    });
  std::map<std::vector<std::size_t>, std::optional<std::size_t>> known;
  const auto best_of = [&](std::span<const std::size_t> drawn) {
    std::vector<std::size_t> sorted(drawn.begin(), drawn.end());
    std::sort(sorted.begin(), sorted.end());
    auto found = known.find(sorted);
    if (found == known.end()) {
      found = known.emplace(sorted, least(table, objective, cases(sorted))).first;
    }
    return found->second;
  };
  for (std::size_t i = 0; i < table.ranges.size(); ++i) {
    best.between.push_back(
        interval([&](std::span<const std::size_t> drawn) -> std::optional<double> {
          const auto point = best_of(drawn);
          return point ? std::optional<double>(table.points[*point][i]) : std::nullopt;
        }));
  }
}

}  // namespace

Result<BestPoint> best_point(const ResponseTable& table, const Objective& objective) {
  const auto all = cases_of(table, "");
  const auto point = least(table, objective, all);
  if (!point) {
    return failure(
        fmt::format("none of {} points has a score '{}'", table.points.size(), objective.score));
  }
  BestPoint best;
  best.point = *point;
  best.values = table.points[*point];
  best.objective = *objective_at(table, objective, *point, all);
  best.defaults = objective_at(table, objective, kDefaults, all);
  best.defaults_diverged = defaults_all_diverged(table);
  if (!best.defaults_diverged) best.gain = gain_over(best.defaults, best.objective);
  for (std::size_t i = 0; i < table.ranges.size(); ++i) {
    best.distance.push_back(fraction_of(table.ranges[i], best.values[i]) -
                            fraction_of(table.ranges[i], table.defaults[i]));
  }
  add_intervals(table, objective, best);
  return best;
}

}  // namespace aims
