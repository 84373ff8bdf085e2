// SPDX-License-Identifier: BSD-3-Clause
#include "bench/tuning/response_summary.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "bench/metrics/statistics.hpp"
#include "bench/tuning/effect.hpp"

namespace aims {
namespace {

constexpr double kInteracts = 0.05;
constexpr double kLeastGain = 0.0005;  ///< of what is not 0.0 % in a text

/// 100 times the fraction, of less than ten with a digit behind the point; never "-0".
std::string hundredfold(double fraction) {
  const bool coarse = std::abs(fraction) >= 0.0995;
  const double rounded =
      coarse ? std::round(100.0 * fraction) : std::round(1000.0 * fraction) / 10.0;
  return fmt::format("{:.{}f}", rounded + 0.0, coarse || rounded == 0.0 ? 0 : 1);
}

std::string percent_text(const std::optional<double>& fraction) {
  return fraction ? hundredfold(*fraction) + " %" : "-";
}

std::string percent_text(const std::optional<double>& fraction, const Interval& interval) {
  std::string text = percent_text(fraction);
  if (!interval.low || !interval.high) return text;
  return text + fmt::format(" [{}, {}]", hundredfold(*interval.low), hundredfold(*interval.high));
}

std::vector<double> scores_of(std::span<const RunScore> runs, std::span<const std::size_t> cases) {
  std::vector<double> scores;
  for (const std::size_t i : cases) {
    if (i < runs.size() && runs[i].value) scores.push_back(*runs[i].value);
  }
  return scores;
}

std::string diverged_text(std::span<const RunScore> runs, std::span<const std::size_t> cases) {
  if (runs.empty()) return "-";
  const auto diverged =
      std::count_if(cases.begin(), cases.end(), [&](std::size_t i) { return runs[i].diverged; });
  return fmt::format("{} of {}", diverged, cases.size());
}

std::vector<std::string> gain_row(const ResponseTable& table, const Objective& objective,
                                  std::size_t point, const std::string& name,
                                  const std::vector<std::size_t>& cases) {
  const SeedGroups seeds = cases_by_seed(table, cases);
  const auto interval = bootstrap_interval(
      seeds.size(),
      [&](std::span<const std::size_t> drawn) {
        return objective_at(table, objective, point, joined(seeds, drawn));
      },
      1);
  return {name,
          figure_text(median(scores_of(table.default_runs, cases))),
          figure_text(median(scores_of(table.runs[point], cases))),
          figure_text(objective_at(table, objective, kDefaults, cases)),
          figure_text(objective_at(table, objective, point, cases), interval),
          diverged_text(table.default_runs, cases),
          diverged_text(table.runs[point], cases)};
}

/// Where the indices come from, or why there are none.
std::string source_text(const Sensitivity& sensitivity) {
  const std::string of = sensitivity.logarithmic ? "the objective's logarithm" : "the objective";
  if (sensitivity.of_grid) {
    return fmt::format(
        "\nIndices by an analysis of variance of {} at the {} points of the complete grid.\n", of,
        sensitivity.points);
  }
  if (sensitivity.of_part) {
    return fmt::format(
        "\nIndices by an analysis of variance of {} at {} points of a grid that is not complete: "
        "effects of the\nlevels{} with a cross-validated R² of {}.\n",
        of, sensitivity.points, sensitivity.of_part->with_pairs ? " and their pairs" : "",
        percent_text(sensitivity.of_part->explained));
  }
  const Surrogate& surrogate = *sensitivity.surrogate;
  const std::string error =
      sensitivity.logarithmic ? fmt::format("{:.0f} %", 100.0 * (std::exp(surrogate.error()) - 1.0))
                              : figure_text(surrogate.error());
  const std::string fit = fmt::format(
      "A polynomial of {} terms through {} points has a\ncross-validated R² of {} for {}; its "
      "error at points left out is {}.\n",
      surrogate.terms(), sensitivity.points, percent_text(std::max(0.0, surrogate.explained())), of,
      error);
  return sensitivity.has_indices()
             ? "\nIndices by a fit. " + fit
             : fmt::format(
                   "\n**Indices are not resolved**, which takes a cross-validated R² of at "
                   "least {:.0f} %. {}",
                   100.0 * kLeastExplained, fit);
}

/// The best value with its interval; none of a parameter without effect.
std::string best_cell(const BestPoint& best, const Sensitivity* sensitivity, std::size_t i) {
  if (best.without_effect[i]) return "no effect measured";
  const bool negligible = sensitivity != nullptr && sensitivity->is_negligible(i);
  return negligible ? figure_text(best.values[i]) + " (negligible effect)"
                    : figure_text(best.values[i], best.between[i]);
}

/// Best minus default in widths of the range; a default of zero has none on a logarithmic one.
std::string distance_cell(const BestPoint& best, std::size_t i) {
  const bool known = !best.without_effect[i] && std::isfinite(best.distance[i]);
  return known ? fmt::format("{:+.2f}", best.distance[i]) : "-";
}

/// Objective and score of the best point, and of the defaults where they are not the best.
std::string best_markdown(const ResponseTable& table, const Objective& objective,
                          const BestPoint& best) {
  const std::string figures =
      fmt::format("an objective of {} and a score (median {}) of {}",
                  figure_text(best.objective, best.objective_interval), objective.score,
                  figure_text(median(scores_of(runs_at(table, best.point), cases_of(table, "")))));
  if (best.is_default()) return fmt::format("The defaults have {}.\n", figures);
  const std::string of_defaults =
      best.defaults ? fmt::format("these have an objective of {}", figure_text(best.defaults))
                    : "these were not run on every sequence";
  return fmt::format("The best of {} points besides the defaults has {}; {}.\n",
                     other_points(table), figures, of_defaults);
}

std::string_view heading_of(Standing standing) {
  switch (standing) {
    case Standing::kKeepDefaults:
      return "Keep the defaults";
    case Standing::kBest:
      return "Best values";
    case Standing::kSmall:
      return "Least objective, too little to matter";
    case Standing::kUnresolved:
      break;
  }
  return "Least objective, not resolved";
}

/// What the best point gains over the defaults.
std::string gain_markdown(const BestPoint& best) {
  if (best.defaults_diverged) return fmt::format("No gain: {}.\n", kNoGain);
  if (best.is_default() || !best.gain) return "";
  const std::string reduction = std::abs(*best.gain) < kLeastGain
                                    ? "less than 0.1 %"
                                    : percent_text(best.gain, best.gain_interval);
  return fmt::format("Reduction by {} on these sequences, among which the best was chosen.\n",
                     reduction);
}

/// The source of the indices, negligible parameters and interactions.
std::string sensitivity_markdown(const ResponseTable& table, const Sensitivity& sensitivity) {
  std::string text = source_text(sensitivity);
  if (!sensitivity.is_resolved()) return text;
  for (std::size_t i = 0; i < table.ranges.size(); ++i) {
    if (!sensitivity.is_negligible(i)) continue;
    text +=
        fmt::format("\n- `{}` has a negligible effect between {} and {}: total index below 5 %.",
                    table.ranges[i].key, table.ranges[i].low, table.ranges[i].high);
  }
  for (std::size_t i = 0; i < table.ranges.size(); ++i) {
    for (std::size_t k = i + 1; k < table.ranges.size(); ++k) {
      const double fraction =
          sensitivity.indices.second(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(k));
      if (fraction < kInteracts) continue;
      text += fmt::format("\n- `{}` and `{}` interact: {} of the variance.", table.ranges[i].key,
                          table.ranges[k].key, percent_text(fraction));
    }
  }
  return text + "\n";
}

}  // namespace

std::string figure_text(const std::optional<double>& value) {
  return value ? fmt::format("{:.3g}", *value) : "-";
}

std::string figure_text(const std::optional<double>& value, const Interval& interval) {
  if (!value || !interval.low || !interval.high) return figure_text(value);
  return fmt::format("{:.3g} [{:.3g}, {:.3g}]", *value, *interval.low, *interval.high);
}

TextTable parameter_table(const ResponseTable& table, const BestPoint& best,
                          const Sensitivity* sensitivity) {
  TextTable text;
  text.header = {"parameter", "range", "default", "best [95 %]",
                 "distance from default [of range]"};
  if (sensitivity != nullptr) {
    text.header.insert(text.header.end(), {"first-order index", "total index [95 %]"});
  }
  for (std::size_t i = 0; i < table.ranges.size(); ++i) {
    const ParameterRange& range = table.ranges[i];
    text.rows.push_back({range.key,
                         fmt::format("{} to {}{}", range.low, range.high, range.log ? ", log" : ""),
                         fmt::format("{}", table.defaults[i]), best_cell(best, sensitivity, i),
                         distance_cell(best, i)});
    if (sensitivity == nullptr) continue;
    if (!sensitivity->is_resolved()) {
      text.rows.back().insert(text.rows.back().end(), {"not resolved", "not resolved"});
      continue;
    }
    const SobolIndices& indices = sensitivity->indices;
    text.rows.back().push_back(percent_text(indices.first[i]));
    text.rows.back().push_back(percent_text(indices.total[i], indices.total_interval[i]));
  }
  return text;
}

TextTable gain_table(const ResponseTable& table, const Objective& planned, std::size_t point) {
  const Objective objective = objective_for(planned, table);
  TextTable text;
  text.header = {"scenario",     "score (median " + objective.score + "), defaults",
                 "tuned",        "objective, defaults",
                 "tuned [95 %]", "diverged, defaults",
                 "tuned"};
  const std::vector<std::size_t> all = cases_of(table, "");
  std::vector<std::string> names;
  for (const std::size_t i : all) {
    const std::string& name = table.cases[i].scenario;
    if (std::find(names.begin(), names.end(), name) == names.end()) names.push_back(name);
  }
  for (const std::string& name : names) {
    std::vector<std::size_t> cases;
    for (const std::size_t i : all) {
      if (table.cases[i].scenario == name) cases.push_back(i);
    }
    text.rows.push_back(gain_row(table, objective, point, name, cases));
  }
  text.rows.push_back(gain_row(table, objective, point, "all", all));
  return text;
}

std::string response_markdown(const ResponseTable& table, const Objective& objective) {
  const auto best = best_point(table, objective);
  if (!best) {
    std::string why = best.error().message + ".\n";
    for (const std::string& line : left_out_lines(table)) why += fmt::format("- {}\n", line);
    return why;
  }
  const Effect effect = effect_of(table, objective);
  const auto sensitivity = table.ranges.size() > 1
                               ? sensitivity_of(table, objective)
                               : Result<Sensitivity>(failure(why_no_indices_of_one(effect)));
  std::string text =
      fmt::format("Objective: {}.\n{}", text_of(objective), best_markdown(table, objective, *best));
  text += fmt::format("{}: {}{}.\n{}", heading_of(standing_of(*best, effect)),
                      text_of(*best, table), unresolved_text(*best, effect), gain_markdown(*best));
  for (const std::string& line : left_out_lines(table)) text += fmt::format("- {}\n", line);
  for (const std::string& line : failed_lines(table)) text += fmt::format("- {}\n", line);
  const std::size_t seeds = seeds_of(table).size();
  text += seeds < 2 ? "One seed: no intervals.\n"
                    : fmt::format("Intervals are 95 % bootstrap intervals over {} seeds{}.\n",
                                  seeds, seeds < 10 ? ", too narrow for so few" : "");
  text += '\n';
  text += to_markdown(parameter_table(table, *best, sensitivity ? &*sensitivity : nullptr));
  text += "\n" + text_of(effect) + "\n";
  text += sensitivity ? sensitivity_markdown(table, *sensitivity)
                      : "\nNo indices: " + sensitivity.error().message + ".\n";
  return text;
}

}  // namespace aims
