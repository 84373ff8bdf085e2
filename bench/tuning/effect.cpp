// SPDX-License-Identifier: BSD-3-Clause
#include "bench/tuning/effect.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <utility>

#include "bench/metrics/statistics.hpp"
#include "bench/scoring/score_statistics.hpp"
#include "core/random.hpp"

namespace aims {
namespace {

constexpr double kEffectLevel = 0.05;
constexpr double kSameScore = 1e-9;  ///< relative
constexpr int kDraws = 199;
constexpr std::size_t kMostArrangements = 2000;  ///< that are all looked at
constexpr double kCovered = 0.5;                 ///< fraction of points, and of spans of parameters
constexpr std::size_t kFewestWithoutOne = 5;     ///< points, to leave one out

/// An objective per seed, of each point.
using Rows = std::vector<std::vector<double>>;

/// Of the points that have one on every seed; logarithms where all are positive.
Rows by_seed(const ResponseTable& table, const Objective& objective, const SeedGroups& seeds) {
  Rows rows;
  bool positive = true;
  for (const std::size_t k : distinct_points(table)) {
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

/// The row whose sum over seeds lies farthest from the mean, and whether it is above it.
std::pair<std::size_t, bool> farthest_row(const Rows& rows) {
  std::vector<double> sums;
  double mean = 0.0;
  for (const auto& row : rows) {
    sums.push_back(std::accumulate(row.begin(), row.end(), 0.0));
    mean += sums.back() / double(rows.size());
  }
  const auto far = [mean](double a, double b) { return std::abs(a - mean) < std::abs(b - mean); };
  const auto farthest = std::ranges::max_element(sums, far);
  return {static_cast<std::size_t>(farthest - sums.begin()), *farthest > mean};
}

/// How many arrangements of the points within seeds there are, up to one that all seeds share; none
/// of many.
std::optional<std::size_t> arrangements_of(std::size_t points, std::size_t seeds) {
  std::size_t of_seed = 1;
  for (std::size_t k = 2; k <= points && of_seed <= kMostArrangements; ++k) of_seed *= k;
  std::size_t all = 1;
  for (std::size_t s = 1; s < seeds && all <= kMostArrangements; ++s) all *= of_seed;
  return all <= kMostArrangements ? std::optional(all) : std::nullopt;
}

/// Of the arrangements of the columns from `seed` on, those whose spread is at least `least`.
std::size_t count_as_large(Rows& columns, std::size_t seed, double least) {
  if (seed == columns.size()) return spread_of(columns) >= least ? 1 : 0;
  const std::vector<double> column = columns[seed];
  std::vector<std::size_t> order(column.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::size_t count = 0;
  do {
    for (std::size_t k = 0; k < order.size(); ++k) columns[seed][k] = column[order[k]];
    count += count_as_large(columns, seed + 1, least);
  } while (std::ranges::next_permutation(order).found);
  columns[seed] = column;
  return count;
}

std::optional<double> p_of(const Rows& rows, std::size_t seeds) {
  if (seeds < 2 || rows.size() < 2) return std::nullopt;
  Rows columns = centered_columns(rows, seeds);
  const double found = spread_of(columns);
  if (const auto all = arrangements_of(rows.size(), seeds)) {
    return double(count_as_large(columns, 1, found * (1.0 - kSameScore))) / double(*all);
  }
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

/// The least p that rows with these values can have: of an effect that is alike on all seeds.
std::optional<double> least_p(const Rows& rows, std::size_t seeds) {
  Rows columns(seeds);
  Rows aligned(rows.size());
  for (std::size_t s = 0; s < seeds; ++s) {
    for (const auto& row : rows) columns[s].push_back(row[s]);
    std::ranges::sort(columns[s]);
    for (std::size_t k = 0; k < rows.size(); ++k) aligned[k].push_back(columns[s][k]);
  }
  return p_of(aligned, seeds);
}

/// Cases on which every run diverged, some with a score, so that all count the penalty.
std::size_t saturated_cases(const ResponseTable& table, const std::vector<std::size_t>& cases) {
  const auto any = [&](std::size_t i, auto&& holds) {
    return std::ranges::any_of(table.runs,
                               [&](const auto& runs) { return i < runs.size() && holds(runs[i]); });
  };
  return static_cast<std::size_t>(std::ranges::count_if(cases, [&](std::size_t i) {
    return any(i, [](const RunScore& run) { return run.value.has_value(); }) &&
           !any(i, [](const RunScore& run) { return !run.diverged; });
  }));
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
  std::vector<std::size_t> points = distinct_points(table);
  if (!table.default_runs.empty()) points.push_back(kDefaults);
  return points;
}

bool are_all_same(const ResponseTable& table, const std::vector<std::size_t>& points) {
  return std::ranges::all_of(points, [&](std::size_t k) {
    return are_same(runs_at(table, points.front()), runs_at(table, k));
  });
}

/// Largest minus smallest fraction of its range that a parameter has at these points.
double span_of(const ResponseTable& table, const std::vector<std::size_t>& points, std::size_t i) {
  double low = 1.0;
  double high = 0.0;
  for (const std::size_t k : points) {
    const double at = std::clamp(fraction_of(table.ranges[i], values_at(table, k)[i]), 0.0, 1.0);
    low = std::min(low, at);
    high = std::max(high, at);
  }
  return std::max(0.0, high - low);
}

/// Whether these points reach over at least half of what all points reach over of a parameter.
bool covers(const ResponseTable& table, const std::vector<std::size_t>& points, std::size_t i) {
  return span_of(table, points, i) >= kCovered * span_of(table, all_points(table), i);
}

/// Points that have the same values of all parameters but one, per such values.
std::vector<std::vector<std::size_t>> groups_along(const ResponseTable& table,
                                                   std::size_t parameter) {
  std::map<std::vector<double>, std::vector<std::size_t>> groups;
  for (const std::size_t k : all_points(table)) {
    std::vector<double> others = values_at(table, k);
    others.erase(others.begin() + static_cast<std::ptrdiff_t>(parameter));
    groups[std::move(others)].push_back(k);
  }
  std::vector<std::vector<std::size_t>> result;
  for (auto& [others, points] : groups) result.push_back(std::move(points));
  return result;
}

/// Whether points that differ in this parameter alone, of which there are some, are all alike.
bool is_alike_in_pairs(const ResponseTable& table, std::size_t parameter) {
  bool any = false;
  for (const auto& points : groups_along(table, parameter)) {
    if (!are_all_same(table, points)) return false;
    any = any || span_of(table, points, parameter) > 0.0;
  }
  return any;
}

/// Whether these points are also enough to say so of all points: at least half of them, and over
/// the ranges of all parameters. A parameter may have no effect at one value of another alone.
bool acts_nowhere(const ResponseTable& table, std::size_t parameter) {
  if (!is_alike_in_pairs(table, parameter)) return false;
  std::vector<std::size_t> compared;
  for (const auto& points : groups_along(table, parameter)) {
    if (span_of(table, points, parameter) > 0.0 && covers(table, points, parameter)) {
      compared.insert(compared.end(), points.begin(), points.end());
    }
  }
  if (compared.empty() || double(compared.size()) < kCovered * double(all_points(table).size())) {
    return false;
  }
  for (std::size_t i = 0; i < table.ranges.size(); ++i) {
    if (!covers(table, compared, i)) return false;
  }
  return true;
}

/// Whether so much is small in the sense of comparisons, in the score's unit.
bool is_small(const ResponseTable& table, const Objective& objective, const Effect& effect) {
  double scale = 1.0;
  if (objective.relative) {
    std::vector<double> scores;
    for (const RunScore& run : table.default_runs) {
      if (run.value && !run.diverged) scores.push_back(*run.value);
    }
    scale = mean(scores).value_or(0.0);
  }
  return scale > 0.0 && (effect.most - effect.least) * scale <=
                            smallest_change(objective.score, effect.least * scale);
}

/// What the objective cannot show.
std::string saturated_text(const Effect& effect) {
  if (effect.saturated == 0) return "";
  return fmt::format(
      " On {} of {} sequences the run diverged at every point and counts the penalty, not its "
      "score: --divergence-penalty 0 counts the score.",
      effect.saturated, effect.cases);
}

/// 0.43, 2.9, 143: never in powers of ten.
std::string percent_text(double percent) {
  const int digits = percent < 0.995 ? 2 : percent < 9.95 ? 1 : 0;
  return fmt::format("{:.{}f} %", percent, digits);
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
  for (const std::size_t k : distinct_points(table)) {
    const auto value = objective_at(table, objective, k, cases);
    if (!value || !is_inside(table, table.points[k])) continue;
    effect.least = effect.points == 0 ? *value : std::min(effect.least, *value);
    effect.most = effect.points == 0 ? *value : std::max(effect.most, *value);
    ++effect.points;
  }
  effect.cases = cases.size();
  if (objective.divergence_penalty > 0.0) effect.saturated = saturated_cases(table, cases);
  if (effect.is_none()) return effect;
  effect.small = is_small(table, objective, effect);
  const SeedGroups seeds = cases_by_seed(table, cases);
  Rows rows = by_seed(table, objective, seeds);
  effect.p = p_of(rows, seeds.size());
  effect.arrangements = arrangements_of(rows.size(), seeds.size()).value_or(0);
  effect.testable = least_p(rows, seeds.size()).value_or(0.0) <= kEffectLevel;
  if (!effect.is_resolved() || !effect.p || rows.size() < kFewestWithoutOne) return effect;
  const auto [farthest, is_worse] = farthest_row(rows);
  effect.one_is_worse = is_worse;
  rows.erase(rows.begin() + static_cast<std::ptrdiff_t>(farthest));
  effect.of_one_point = least_p(rows, seeds.size()).value_or(1.0) <= kEffectLevel &&
                        p_of(rows, seeds.size()).value_or(0.0) > kEffectLevel;
  return effect;
}

std::string text_of(const Effect& effect) {
  if (effect.points < 2) return "Fewer than two points have an objective: no effect is known.";
  if (effect.is_none()) {
    return fmt::format("The objective is {:.3g} at all {} points: no effect was measured.{}",
                       effect.least, effect.points, saturated_text(effect));
  }
  std::string text = fmt::format("The objective lies between {:.4g} and {:.4g} at the {} points",
                                 effect.least, effect.most, effect.points);
  if (effect.least > 0.0) {
    text +=
        fmt::format(" ({} of the least)", percent_text(100.0 * (effect.most / effect.least - 1.0)));
  }
  if (!effect.is_resolved()) {
    text += !effect.testable ? ": not resolved: too few seeds and points for the test below"
            : effect.p       ? ": not resolved, since seeds scatter as much"
                             : ": not resolved, since with one seed less than 5 % may be scatter";
  } else {
    text += effect.p ? ", beyond the scatter of seeds" : "; with one seed its scatter is unknown";
    if (effect.of_one_point) text += ", by a single point alone: without it, it is not resolved";
    if (effect.small) text += "; small, as comparisons call it (5 % or the score's floor)";
  }
  text += ".";
  if (effect.p) {
    text += fmt::format(
        " p = {:.2g}: permutation test on the variance over points of their sums over seeds, {}.",
        *effect.p,
        effect.arrangements > 0 ? fmt::format("all {} arrangements", effect.arrangements)
                                : fmt::format("{} draws", kDraws));
  }
  return text + saturated_text(effect);
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

std::vector<bool> alike_in_pairs(const ResponseTable& table) {
  std::vector<bool> alike;
  for (std::size_t i = 0; i < table.ranges.size(); ++i) {
    alike.push_back(is_alike_in_pairs(table, i));
  }
  return alike;
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
