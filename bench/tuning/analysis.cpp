// SPDX-License-Identifier: BSD-3-Clause
#include "bench/tuning/analysis.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "bench/scoring/score_statistics.hpp"
#include "bench/tuning/effect.hpp"
#include "bench/tuning/held_out.hpp"
#include "bench/tuning/range_key.hpp"

namespace aims {
namespace {

constexpr std::uint64_t kBootstrapSeed = 1;
constexpr double kTie = 1e-9;  ///< relative

/// In widths of the ranges, over all parameters.
double distance_from_defaults(const ResponseTable& table, std::size_t point) {
  const std::vector<double>& values = values_at(table, point);
  // Zero lies at minus infinity on a logarithmic range.
  const auto fraction = [&](std::size_t i, double value) {
    return std::clamp(fraction_of(table.ranges[i], value), -1.0, 2.0);
  };
  double distance = 0.0;
  for (std::size_t i = 0; i < values.size(); ++i) {
    distance += std::abs(fraction(i, values[i]) - fraction(i, table.defaults[i]));
  }
  return distance;
}

/// Fills the intervals of `best`.
void add_intervals(const ResponseTable& table, const Objective& objective, BestPoint& best) {
  const SeedGroups seeds = cases_by_seed(table, cases_of(table, ""));
  const auto cases = [&](std::span<const std::size_t> drawn) { return joined(seeds, drawn); };
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
      found = known.emplace(sorted, least_point(table, objective, cases(sorted))).first;
    }
    return found->second;
  };
  for (std::size_t i = 0; i < table.ranges.size(); ++i) {
    if (best.without_effect[i]) {
      best.between.emplace_back();
      continue;
    }
    best.between.push_back(
        interval([&](std::span<const std::size_t> drawn) -> std::optional<double> {
          const auto point = best_of(drawn);
          return point ? std::optional<double>(values_at(table, *point)[i]) : std::nullopt;
        }));
  }
}

}  // namespace

std::optional<std::size_t> least_point(const ResponseTable& table, const Objective& objective,
                                       std::span<const std::size_t> cases) {
  std::vector<std::pair<std::size_t, double>> values;
  const auto add = [&](std::size_t point) {
    if (const auto value = objective_at(table, objective, point, cases)) {
      values.emplace_back(point, *value);
    }
  };
  add(kDefaults);
  for (std::size_t k = 0; k < table.points.size(); ++k) add(k);
  if (values.empty()) return std::nullopt;
  const double least = std::ranges::min(values, {}, &std::pair<std::size_t, double>::second).second;
  std::erase_if(values,
                [&](const auto& each) { return each.second > least + kTie * std::abs(least); });
  return std::ranges::min(
             values, {},
             [&](const auto& each) { return distance_from_defaults(table, each.first); })
      .first;
}

std::string text_of(const BestPoint& best, const ResponseTable& table) {
  const std::string values =
      values_text(table.ranges, table.defaults, best.values, best.without_effect);
  return best.is_default() ? "no point is better than the defaults: " + values : values;
}

bool is_resolved(const BestPoint& best, const Effect& effect) {
  const bool gains = best.gain_interval.low && *best.gain_interval.low > 0.0;
  return effect.tells_best() && (best.is_default() || best.defaults_diverged || gains);
}

std::string unresolved_text(const BestPoint& best, const Effect& effect) {
  if (is_resolved(best, effect) || !effect.tells_best()) return "";
  if (!best.gain_interval.low) return "; the gain over the defaults has no interval";
  return fmt::format("; points differ, but the gain over the defaults, {} to {}, may be none",
                     change_text(*best.gain_interval.low), change_text(*best.gain_interval.high));
}

Standing standing_of(const BestPoint& best, const Effect& effect) {
  if (best.is_default()) return Standing::kKeepDefaults;
  if (!is_resolved(best, effect)) return Standing::kUnresolved;
  const bool small = effect.small || (best.gain && *best.gain <= kMinChange);
  return small ? Standing::kSmall : Standing::kBest;
}

std::string_view name_of(Standing standing) {
  switch (standing) {
    case Standing::kKeepDefaults:
      return "least: keep the defaults";
    case Standing::kBest:
      return "best";
    case Standing::kSmall:
      return "least, too little to matter";
    case Standing::kUnresolved:
      break;
  }
  return "least, not resolved";
}

Result<BestPoint> best_point(const ResponseTable& table, const Objective& objective) {
  if (objective.divergence_penalty > 0.0 && all_diverged(table)) {
    const bool scored = std::ranges::any_of(table.runs, [](const auto& runs) {
      return std::ranges::any_of(runs, [](const RunScore& run) { return run.value.has_value(); });
    });
    return failure(fmt::format(
        "every run diverged or failed and counts the divergence penalty or more, so that no point "
        "is better than another{}",
        scored ? "; a divergence penalty of 0 (aims merge FOLDER --divergence-penalty 0) counts "
                 "their scores"
               : ""));
  }
  const auto all = cases_of(table, "");
  const auto point = least_point(table, objective, all);
  bool any_point = false;
  bool any_other = other_points(table) == 0;
  for (std::size_t k = 0; k < table.points.size(); ++k) {
    if (!objective_at(table, objective, k, all)) continue;
    any_point = true;
    any_other = any_other || table.points[k] != table.defaults;
  }
  if (all.empty()) return failure("no sequence has a valid run at every point");
  if (!point || !any_point) {
    return failure(
        fmt::format("none of {} points has a score '{}'", table.points.size(), objective.score));
  }
  if (!any_other) return failure("no point besides the defaults has a run to compare with them");
  BestPoint best;
  best.point = *point;
  best.values = values_at(table, *point);
  best.without_effect = without_effect(table);
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
