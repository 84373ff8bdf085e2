// SPDX-License-Identifier: BSD-3-Clause
#include "bench/tuning/slice.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <utility>

#include "bench/tuning/sensitivity.hpp"

namespace aims {
namespace {

constexpr std::uint64_t kIntervalSeed = 1;
constexpr int kCurveSteps = 25;
constexpr int kMapSteps = 24;

bool varies(const Slice& slice, std::size_t i) { return i == slice.first || i == slice.second; }

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

bool lies_on(const std::vector<double>& point, const Slice& slice) {
  for (std::size_t i = 0; i < point.size(); ++i) {
    if (!varies(slice, i) && point[i] != slice.held[i]) return false;
  }
  return true;
}

/// Points of the design on the slice.
std::vector<std::size_t> points_on(const ResponseTable& table, const Slice& slice) {
  std::vector<std::size_t> on;
  for (std::size_t k = 0; k < table.points.size(); ++k) {
    if (lies_on(table.points[k], slice)) on.push_back(k);
  }
  return on;
}

/// Different values of parameter i among these points.
std::size_t levels(const ResponseTable& table, std::span<const std::size_t> points, std::size_t i) {
  std::set<double> values;
  for (const std::size_t k : points) values.insert(table.points[k][i]);
  return values.size();
}

std::size_t levels(const ResponseTable& table, std::size_t i) {
  std::set<double> values;
  for (const auto& point : table.points) values.insert(point[i]);
  return values.size();
}

SlicePoint measured_point(const ResponseTable& table, const Objective& objective, std::size_t point,
                          const Slice& slice) {
  const auto& values = values_at(table, point);
  SlicePoint result;
  result.x = values[slice.first];
  if (slice.second) result.y = values[*slice.second];
  const auto cases = cases_of(table, slice.family);
  result.objective = objective_at(table, objective, point, cases);
  if (slice.second) return result;
  const SeedGroups seeds = cases_by_seed(table, cases);
  result.interval = bootstrap_interval(
      seeds.size(),
      [&](std::span<const std::size_t> drawn) {
        return objective_at(table, objective, point, joined(seeds, drawn));
      },
      kIntervalSeed);
  return result;
}

/// The defaults are a point of the slice that no point of the design is.
bool adds_defaults(const ResponseTable& table, const Slice& slice) {
  return !table.default_runs.empty() && lies_on(table.defaults, slice) &&
         std::find(table.points.begin(), table.points.end(), table.defaults) == table.points.end();
}

void add_measured(const ResponseTable& table, const Objective& objective,
                  std::span<const std::size_t> points, Slice& slice) {
  for (const std::size_t k : points) {
    slice.measured.push_back(measured_point(table, objective, k, slice));
  }
  if (!slice.second && adds_defaults(table, slice)) {
    slice.measured.push_back(measured_point(table, objective, kDefaults, slice));
  }
  std::sort(slice.measured.begin(), slice.measured.end(),
            [](const auto& a, const auto& b) { return std::pair(a.y, a.x) < std::pair(b.y, b.x); });
}

SlicePoint fitted_point(const Sensitivity& sensitivity, const Eigen::VectorXd& fractions) {
  const Surrogate& surrogate = *sensitivity.surrogate;
  if (surrogate.extrapolates(fractions)) return {};
  const double value = surrogate.at(fractions);
  const double half = 1.96 * surrogate.error_at(fractions);
  const auto back = [&](double fitted) {
    return sensitivity.logarithmic ? std::exp(fitted) : fitted;
  };
  SlicePoint point;
  point.objective = back(value);
  point.interval = {back(value - half), back(value + half)};
  return point;
}

void add_fit(const ResponseTable& table, const Objective& objective, Slice& slice) {
  if (levels(table, slice.first) < kFittedLevels) return;
  if (slice.second && levels(table, *slice.second) < kFittedLevels) return;
  const auto sensitivity = sensitivity_of(table, objective, slice.family);
  if (!sensitivity || !sensitivity->is_fitted()) return;
  Eigen::VectorXd fractions = fractions_of(table, slice.held);
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
      slice.fit.push_back(point);
    }
  }
  const auto known = [](const SlicePoint& point) { return point.objective.has_value(); };
  if (std::none_of(slice.fit.begin(), slice.fit.end(), known)) slice.fit.clear();
}

/// A slice through the grid, where the points have one there, else through the defaults.
Slice empty_slice(const ResponseTable& table, Slice slice) {
  slice.held = table.defaults;
  if (table.points.empty()) return slice;
  Slice of_grid = slice;
  for (std::size_t i = 0; i < of_grid.held.size(); ++i) {
    of_grid.held[i] = level_next_to_default(table, i);
  }
  const auto on = points_on(table, of_grid);
  const std::size_t columns = levels(table, on, slice.first);
  const std::size_t rows = slice.second ? levels(table, on, *slice.second) : 1;
  const bool whole = columns >= 2 && (!slice.second || (rows >= 2 && on.size() == rows * columns));
  return whole ? of_grid : slice;
}

}  // namespace

Slice curve_of(const ResponseTable& table, const Objective& objective, std::size_t parameter,
               const std::string& family) {
  Slice slice = empty_slice(table, {parameter, std::nullopt, family, {}, {}, {}});
  add_measured(table, objective, points_on(table, slice), slice);
  add_fit(table, objective, slice);
  if (slice.measured.size() < 2 && slice.fit.empty()) slice.measured.clear();
  return slice;
}

Slice map_of(const ResponseTable& table, const Objective& objective, std::size_t first,
             std::size_t second, const std::string& family) {
  Slice slice = empty_slice(table, {first, second, family, {}, {}, {}});
  const auto on = points_on(table, slice);
  const std::size_t columns = levels(table, on, first);
  const std::size_t rows = levels(table, on, second);
  const bool whole = columns >= 2 && rows >= 2 && on.size() == rows * columns;
  if (whole) {
    add_measured(table, objective, on, slice);
  } else {
    add_fit(table, objective, slice);
  }
  return slice;
}

std::string held_text(const ResponseTable& table, const Slice& slice) {
  std::vector<std::string> held;
  for (std::size_t i = 0; i < slice.held.size(); ++i) {
    if (varies(slice, i)) continue;
    const bool is_default = slice.held[i] == table.defaults[i];
    held.push_back(
        fmt::format("{} = {:.4g}{}", table.ranges[i].key, slice.held[i],
                    is_default ? "" : fmt::format(" (default {:.4g})", table.defaults[i])));
  }
  return fmt::format("{}", fmt::join(held, ", "));
}

}  // namespace aims
