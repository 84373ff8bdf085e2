// SPDX-License-Identifier: BSD-3-Clause
#include "bench/tuning/analysis.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <set>

namespace aims {
namespace {

constexpr std::uint64_t kBootstrapSeed = 1;
constexpr double kNegligibleIndex = 0.05;
constexpr int kCurveSteps = 25;
constexpr int kMapSteps = 24;

/// Cases of the seeds with these indices, each seed with all its scenarios of the family.
std::vector<std::size_t> cases_of_seeds(const ResponseTable& table, const std::string& family,
                                        const std::vector<std::uint64_t>& seeds,
                                        std::span<const std::size_t> drawn) {
  std::vector<std::size_t> cases;
  const auto all = cases_of(table, family);
  for (const std::size_t index : drawn) {
    for (const std::size_t i : all) {
      if (table.cases[i].seed == seeds[index]) cases.push_back(i);
    }
  }
  return cases;
}

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

std::optional<double> gain_over(const std::optional<double>& defaults,
                                const std::optional<double>& best) {
  if (!defaults || !best || !(*defaults > 0.0)) return std::nullopt;
  return 1.0 - *best / *defaults;
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

/// A row of fractions of each parameter's range.
Eigen::VectorXd fractions_of(const ResponseTable& table, const std::vector<double>& values) {
  Eigen::VectorXd fractions(static_cast<Eigen::Index>(values.size()));
  for (std::size_t i = 0; i < values.size(); ++i) {
    fractions(static_cast<Eigen::Index>(i)) =
        std::clamp(fraction_of(table.ranges[i], values[i]), 0.0, 1.0);
  }
  return fractions;
}

/// The value of parameter i among the points that is next to its default.
double level_next_to_default(const ResponseTable& table, std::size_t i) {
  const auto distance = [&](double value) {
    return std::abs(fraction_of(table.ranges[i], value) -
                    std::clamp(fraction_of(table.ranges[i], table.defaults[i]), 0.0, 1.0));
  };
  double best = table.points.front()[i];
  for (const auto& point : table.points) {
    if (distance(point[i]) < distance(best)) best = point[i];
  }
  return best;
}

/// Points that vary in the free parameters alone, all others next to their defaults.
std::vector<std::size_t> points_on(const ResponseTable& table, const std::set<std::size_t>& free) {
  std::vector<std::size_t> on;
  if (table.points.empty()) return on;
  std::vector<double> reference(table.ranges.size());
  for (std::size_t i = 0; i < reference.size(); ++i) reference[i] = level_next_to_default(table, i);
  for (std::size_t k = 0; k < table.points.size(); ++k) {
    bool fits = true;
    for (std::size_t i = 0; i < reference.size(); ++i) {
      fits = fits && (free.contains(i) || table.points[k][i] == reference[i]);
    }
    if (fits) on.push_back(k);
  }
  return on;
}

SlicePoint measured_point(const ResponseTable& table, const Objective& objective, std::size_t point,
                          const Slice& slice) {
  const auto seeds = seeds_of(table);
  SlicePoint result;
  result.x = table.points[point][slice.first];
  if (slice.second) result.y = table.points[point][*slice.second];
  result.objective = objective_at(table, objective, point, cases_of(table, slice.family));
  if (slice.second) return result;
  result.interval = bootstrap_interval(
      seeds.size(),
      [&](std::span<const std::size_t> drawn) {
        return objective_at(table, objective, point,
                            cases_of_seeds(table, slice.family, seeds, drawn));
      },
      kBootstrapSeed);
  return result;
}

SlicePoint fitted_point(const Sensitivity& sensitivity, const Eigen::VectorXd& fractions) {
  if (sensitivity.surrogate.extrapolates(fractions)) return {};
  const double value = sensitivity.surrogate.at(fractions);
  const double half = 1.96 * sensitivity.surrogate.error_at(fractions);
  const auto back = [&](double fitted) {
    return sensitivity.logarithmic ? std::exp(fitted) : fitted;
  };
  SlicePoint point;
  point.objective = back(value);
  point.interval = {back(value - half), back(value + half)};
  return point;
}

void fill_from_surrogate(const ResponseTable& table, const Objective& objective, Slice& slice) {
  const auto sensitivity = sensitivity_of(table, objective, slice.family);
  if (!sensitivity || !sensitivity->is_reliable()) return;
  Eigen::VectorXd fractions = fractions_of(table, table.defaults);
  const int steps = slice.second ? kMapSteps : kCurveSteps;
  for (int row = 0; row < (slice.second ? steps : 1); ++row) {
    for (int column = 0; column < steps; ++column) {
      const double x = double(column) / (steps - 1);
      const double y = double(row) / (steps - 1);
      fractions(static_cast<Eigen::Index>(slice.first)) = x;
      if (slice.second) fractions(static_cast<Eigen::Index>(*slice.second)) = y;
      SlicePoint point = fitted_point(*sensitivity, fractions);
      point.x = value_at(table.ranges[slice.first], x);
      if (slice.second) point.y = value_at(table.ranges[*slice.second], y);
      slice.points.push_back(point);
    }
  }
  const auto known = [](const SlicePoint& point) { return point.objective.has_value(); };
  if (std::none_of(slice.points.begin(), slice.points.end(), known)) slice.points.clear();
}

/// Different values of parameter i among these points.
std::size_t levels(const ResponseTable& table, std::span<const std::size_t> points, std::size_t i) {
  std::set<double> values;
  for (const std::size_t k : points) values.insert(table.points[k][i]);
  return values.size();
}

Slice slice_of(const ResponseTable& table, const Objective& objective, Slice slice) {
  std::set<std::size_t> free = {slice.first};
  if (slice.second) free.insert(*slice.second);
  const auto on = points_on(table, free);
  slice.measured = levels(table, on, slice.first) >= 3;
  if (slice.second) {
    const std::size_t rows = levels(table, on, *slice.second);
    slice.measured =
        slice.measured && rows >= 3 && on.size() == rows * levels(table, on, slice.first);
  }
  if (!slice.measured) {
    fill_from_surrogate(table, objective, slice);
    return slice;
  }
  for (const std::size_t k : on) {
    slice.points.push_back(measured_point(table, objective, k, slice));
  }
  std::sort(slice.points.begin(), slice.points.end(),
            [](const auto& a, const auto& b) { return std::pair(a.y, a.x) < std::pair(b.y, b.x); });
  return slice;
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
  best.gain = gain_over(best.defaults, best.objective);
  for (std::size_t i = 0; i < table.ranges.size(); ++i) {
    best.distance.push_back(fraction_of(table.ranges[i], best.values[i]) -
                            fraction_of(table.ranges[i], table.defaults[i]));
  }
  add_intervals(table, objective, best);
  return best;
}

bool Sensitivity::is_negligible(std::size_t parameter) const {
  const SobolIndices& indices = surrogate.indices();
  if (!is_reliable()) return false;
  return indices.total[parameter] < kNegligibleIndex &&
         indices.total_interval[parameter].high.value_or(1.0) < kNegligibleIndex;
}

Result<Sensitivity> sensitivity_of(const ResponseTable& table, const Objective& objective,
                                   const std::string& family) {
  const auto cases = cases_of(table, family);
  std::vector<double> values;
  std::vector<Eigen::VectorXd> rows;
  for (std::size_t k = 0; k < table.points.size(); ++k) {
    const auto value = objective_at(table, objective, k, cases);
    if (!value) continue;
    values.push_back(*value);
    rows.push_back(fractions_of(table, table.points[k]));
  }
  Sensitivity sensitivity;
  sensitivity.points = values.size();
  sensitivity.logarithmic =
      std::all_of(values.begin(), values.end(), [](double value) { return value > 0.0; });
  const auto inputs = static_cast<Eigen::Index>(table.ranges.size());
  Eigen::MatrixXd points(static_cast<Eigen::Index>(rows.size()), inputs);
  Eigen::VectorXd targets(static_cast<Eigen::Index>(rows.size()));
  for (std::size_t k = 0; k < rows.size(); ++k) {
    points.row(static_cast<Eigen::Index>(k)) = rows[k].transpose();
    targets(static_cast<Eigen::Index>(k)) =
        sensitivity.logarithmic ? std::log(values[k]) : values[k];
  }
  auto surrogate = Surrogate::fit(points, targets);
  if (!surrogate) return tl::unexpected(surrogate.error());
  sensitivity.surrogate = std::move(*surrogate);
  return sensitivity;
}

Slice curve_of(const ResponseTable& table, const Objective& objective, std::size_t parameter,
               const std::string& family) {
  return slice_of(table, objective, {parameter, std::nullopt, family, false, {}});
}

Slice map_of(const ResponseTable& table, const Objective& objective, std::size_t first,
             std::size_t second, const std::string& family) {
  return slice_of(table, objective, {first, second, family, false, {}});
}

}  // namespace aims
