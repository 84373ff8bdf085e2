// SPDX-License-Identifier: BSD-3-Clause
#include "bench/tuning/effect.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "bench/scoring/score_statistics.hpp"
#include "core/random.hpp"

namespace aims {
namespace {

constexpr double kEffectLevel = 0.05;
constexpr double kSameScore = 1e-9;  ///< relative
constexpr int kDraws = 199;

/// An objective per seed, of each point.
using Rows = std::vector<std::vector<double>>;

/// Of the points that have one on every seed; logarithms where all are positive.
Rows by_seed(const ResponseTable& table, const Objective& objective, const SeedGroups& seeds) {
  Rows rows;
  bool positive = true;
  for (std::size_t k = 0; k < table.points.size(); ++k) {
    if (!is_inside(table, table.points[k])) continue;
    std::vector<double> row;
    for (const auto& cases : seeds) {
      const auto value = objective_at(table, objective, k, cases);
      if (!value) break;
      positive = positive && *value > 0.0;
      row.push_back(*value);
    }
    if (row.size() == seeds.size()) rows.push_back(std::move(row));
  }
  for (auto& row : rows) {
    for (double& value : row) value = positive ? std::log(value) : value;
  }
  return rows;
}

/// A column per seed, without its mean, which is no effect of points.
Rows centered_columns(const Rows& rows, std::size_t seeds) {
  Rows columns(seeds);
  for (std::size_t s = 0; s < seeds; ++s) {
    double sum = 0.0;
    for (const auto& row : rows) sum += row[s];
    for (const auto& row : rows) columns[s].push_back(row[s] - sum / double(rows.size()));
  }
  return columns;
}

/// Sum of the squares of the points' sums over seeds.
double spread_of(const Rows& columns) {
  double spread = 0.0;
  for (std::size_t k = 0; k < columns.front().size(); ++k) {
    double sum = 0.0;
    for (const auto& column : columns) sum += column[k];
    spread += sum * sum;
  }
  return spread;
}

std::optional<double> p_of(const Rows& rows, std::size_t seeds) {
  if (seeds < 2 || rows.size() < 2) return std::nullopt;
  Rows columns = centered_columns(rows, seeds);
  const double found = spread_of(columns);
  RandomStream random = rng(1, "effect");
  int as_large = 1;
  for (int draw = 0; draw < kDraws; ++draw) {
    for (auto& column : columns) {
      for (std::size_t k = column.size() - 1; k > 0; --k) {
        const auto other = std::min(k, static_cast<std::size_t>(random.uniform() * double(k + 1)));
        std::swap(column[k], column[other]);
      }
    }
    as_large += spread_of(columns) >= found * (1.0 - kSameScore) ? 1 : 0;
  }
  return as_large / (kDraws + 1.0);
}

bool is_same(double a, double b) { return std::abs(a - b) <= kSameScore * std::abs(a); }

bool is_same(const RunScore& a, const RunScore& b) {
  if (a.diverged != b.diverged || a.value.has_value() != b.value.has_value()) return false;
  return !a.value || is_same(*a.value, *b.value);
}

bool are_same(const std::vector<RunScore>& a, const std::vector<RunScore>& b) {
  return std::ranges::equal(a, b, [](const auto& x, const auto& y) { return is_same(x, y); });
}

/// The points, and the defaults where they were run.
std::vector<std::size_t> all_points(const ResponseTable& table) {
  std::vector<std::size_t> points;
  for (std::size_t k = 0; k < table.points.size(); ++k) points.push_back(k);
  if (!table.default_runs.empty()) points.push_back(kDefaults);
  return points;
}

bool are_all_same(const ResponseTable& table, const std::vector<std::size_t>& points) {
  return std::ranges::all_of(points, [&](std::size_t k) {
    return are_same(runs_at(table, points.front()), runs_at(table, k));
  });
}

/// Points with the same values of all parameters but one.
bool acts_nowhere(const ResponseTable& table, std::size_t parameter) {
  std::map<std::vector<double>, std::vector<std::size_t>> groups;
  for (const std::size_t k : all_points(table)) {
    std::vector<double> others = values_at(table, k);
    others.erase(others.begin() + static_cast<std::ptrdiff_t>(parameter));
    groups[std::move(others)].push_back(k);
  }
  bool any = false;
  for (const auto& [others, points] : groups) {
    if (!are_all_same(table, points)) return false;
    any = any || std::ranges::any_of(points, [&](std::size_t k) {
            return values_at(table, k)[parameter] != values_at(table, points.front())[parameter];
          });
  }
  return any;
}

}  // namespace

bool Effect::is_none() const { return is_same(least, most); }

bool Effect::is_resolved() const {
  if (is_none()) return false;
  return p ? *p <= kEffectLevel : most - least > kMinChange * std::abs(least);
}

Effect effect_of(const ResponseTable& table, const Objective& objective,
                 const std::string& family) {
  const auto cases = cases_of(table, family);
  Effect effect;
  for (std::size_t k = 0; k < table.points.size(); ++k) {
    const auto value = objective_at(table, objective, k, cases);
    if (!value || !is_inside(table, table.points[k])) continue;
    effect.least = effect.points == 0 ? *value : std::min(effect.least, *value);
    effect.most = effect.points == 0 ? *value : std::max(effect.most, *value);
    ++effect.points;
  }
  const SeedGroups seeds = cases_by_seed(table, cases);
  if (!effect.is_none()) effect.p = p_of(by_seed(table, objective, seeds), seeds.size());
  return effect;
}

std::string text_of(const Effect& effect) {
  if (effect.points < 2) return "Fewer than two points have an objective: no effect is known.";
  if (effect.is_none()) {
    return fmt::format("The objective is {:.3g} at all {} points: no effect was measured.",
                       effect.least, effect.points);
  }
  std::string text = fmt::format("The objective lies between {:.4g} and {:.4g} at the {} points",
                                 effect.least, effect.most, effect.points);
  if (effect.least > 0.0) {
    text += fmt::format(" ({:.2g} %)", 100.0 * (effect.most / effect.least - 1.0));
  }
  if (!effect.p) {
    return text + (effect.is_resolved() ? "; with one seed its scatter is unknown."
                                        : ": not resolved, since with one seed less than 5 % may "
                                          "be scatter.");
  }
  return text + fmt::format("{} (p = {:.2g}).",
                            effect.is_resolved() ? ", beyond the scatter of seeds"
                                                 : ": not resolved, since seeds scatter as much",
                            *effect.p);
}

std::vector<bool> without_effect(const ResponseTable& table) {
  const auto points = all_points(table);
  if (points.size() > 1 && are_all_same(table, points)) {
    return std::vector<bool>(table.ranges.size(), true);
  }
  std::vector<bool> without;
  for (std::size_t i = 0; i < table.ranges.size(); ++i) without.push_back(acts_nowhere(table, i));
  return without;
}

bool is_inside(const ResponseTable& table, const std::vector<double>& values) {
  for (std::size_t i = 0; i < values.size(); ++i) {
    const double slack = kSameScore * (table.ranges[i].high - table.ranges[i].low);
    if (values[i] < table.ranges[i].low - slack || values[i] > table.ranges[i].high + slack) {
      return false;
    }
  }
  return true;
}

}  // namespace aims
