// SPDX-License-Identifier: BSD-3-Clause
#include "bench/tuning/objective.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <string_view>
#include <utility>

#include "bench/metrics/statistics.hpp"
#include "bench/scoring/score_list.hpp"
#include "bench/scoring/score_record.hpp"
#include "bench/scoring/validity.hpp"

namespace aims {
namespace {

std::optional<double> statistic_of(const Objective& objective, const std::vector<double>& values) {
  switch (objective.statistic) {
    case ObjectiveStatistic::kMedian:
      return median(values);
    case ObjectiveStatistic::kWorst:
      return quantile(values, 1.0);
    case ObjectiveStatistic::kMean:
      return mean(values);
    case ObjectiveStatistic::kQuantile:
      return quantile(values, objective.quantile);
  }
  return std::nullopt;
}

/// Relative score of a run where that of the defaults failed: as where both are alike.
constexpr double kOfNoDefault = 1.0;

/// The run's score as it counts when the run did not diverge.
std::optional<double> counted(const Objective& objective, const RunScore& run,
                              const RunScore* reference) {
  if (!run.value || !std::isfinite(*run.value)) return std::nullopt;
  if (!objective.relative) return run.value;
  if (reference != nullptr && !reference->value && reference->diverged) return kOfNoDefault;
  if (reference == nullptr || !reference->value || !(*reference->value > 0.0)) return std::nullopt;
  return *run.value / *reference->value;
}

bool is_valid(const std::vector<RunScore>& runs, std::size_t i) {
  return i < runs.size() && runs[i].invalid.empty();
}

/// Per case, whether it is valid at each point that is valid on at least half of the cases on which
/// any point is: points are compared on the same cases, and one at which the robot keeps falling is
/// left out itself. Without runs all are.
std::vector<bool> common_cases(const ResponseTable& table) {
  std::vector<const std::vector<RunScore>*> points;
  if (!table.default_runs.empty()) points.push_back(&table.default_runs);
  for (const auto& runs : table.runs) points.push_back(&runs);
  std::vector<bool> common(table.cases.size(), true);
  std::vector<std::size_t> valid_points(table.cases.size(), 0);
  for (const auto* runs : points) {
    for (std::size_t i = 0; i < common.size(); ++i) valid_points[i] += is_valid(*runs, i) ? 1 : 0;
  }
  const auto known = static_cast<std::size_t>(
      std::ranges::count_if(valid_points, [](std::size_t count) { return count > 0; }));
  for (const auto* runs : points) {
    std::size_t own = 0;
    for (std::size_t i = 0; i < common.size(); ++i) own += is_valid(*runs, i) ? 1 : 0;
    if (2 * own < known) continue;
    for (std::size_t i = 0; i < common.size(); ++i) common[i] = common[i] && is_valid(*runs, i);
  }
  return common;
}

/// What scores on that case are relative to: the run of the defaults; where it was lost without a
/// score, the median of the points that have one, so that their order stays.
RunScore reference_at(const ResponseTable& table, std::size_t i) {
  RunScore reference = table.default_runs[i];
  if (reference.value || !reference.diverged) return reference;
  std::vector<double> values;
  for (const auto& runs : table.runs) {
    if (i < runs.size() && runs[i].value && !runs[i].diverged) values.push_back(*runs[i].value);
  }
  reference.value = median(values);
  return reference;
}

template <class Value>
void append_new(std::vector<Value>& values, const Value& value) {
  if (std::find(values.begin(), values.end(), value) == values.end()) values.push_back(value);
}

}  // namespace

void describe(Fields& fields, Objective& objective) {
  fields.text("score", objective.score, {.meaning = "dotted key of scores.json, to be minimized"});
  fields.choice("statistic", objective.statistic,
                {{"median", ObjectiveStatistic::kMedian},
                 {"worst", ObjectiveStatistic::kWorst},
                 {"mean", ObjectiveStatistic::kMean},
                 {"quantile", ObjectiveStatistic::kQuantile}},
                {.meaning = "of the runs' scores"});
  fields.number("quantile", objective.quantile,
                {.unit = "-",
                 .range = {.min = 0.0, .max = 1.0, .min_included = false, .max_included = false},
                 .meaning = "which, for the statistic 'quantile'"});
  fields.flag("relative", objective.relative,
              {.meaning = "divide each score by that of the default setting on the same sequence"});
  fields.number("divergence_penalty", objective.divergence_penalty,
                {.range = {.min = 0.0, .max = 1e9},
                 .meaning = "value of a diverged run; added times the fraction of diverged runs; "
                            "0: a diverged run counts by its score"});
}

std::string text_of(const Objective& objective) {
  std::string statistic = "median";
  if (objective.statistic == ObjectiveStatistic::kWorst) statistic = "worst";
  if (objective.statistic == ObjectiveStatistic::kMean) statistic = "mean";
  if (objective.statistic == ObjectiveStatistic::kQuantile) {
    statistic = fmt::format("{} quantile", objective.quantile);
  }
  const char* timing =
      is_timing(objective.score) ? "; a time depends on the machine and on its load" : "";
  const std::string penalty =
      objective.divergence_penalty == 0.0
          ? fmt::format("a diverged run counts by its score, {} without one or with poses missing",
                        kWithoutScore)
          : fmt::format("a diverged run counts at least {0}, and {0} times their fraction is added",
                        objective.divergence_penalty);
  const char* over = objective.relative ? " over that of the defaults" : "";
  if (objective.relative && objective.lost_defaults) {
    over = " over that of the defaults, where these were lost over the median of the points";
  }
  if (objective.without_ratio) over = ", as the defaults have 0 on some sequence";
  return fmt::format("{} of {}{}; {}{}", statistic, objective.score, over, penalty, timing);
}

std::string value_label(const Objective& objective) {
  if (objective.relative) return objective.score + " over the defaults'";
  const std::string_view unit = unit_of(objective.score);
  return unit.empty() ? objective.score : fmt::format("{} [{}]", objective.score, unit);
}

std::string axis_label(const Objective& objective) {
  return "objective: " + value_label(objective);
}

RunScore run_score(const JobResult& job, const std::string& score) {
  if (auto reason = invalid_reason(job.sequence)) return {std::nullopt, false, std::move(*reason)};
  const bool done = job.outcome == JobOutcome::kDone;
  return {is_partial(job.scores) ? std::nullopt : score_in(job, score),
          !done || score_in(job, "success") == 0.0, "", done ? "" : job.message};
}

std::optional<double> objective_value(const Objective& objective, std::span<const RunScore> runs,
                                      std::span<const RunScore> reference) {
  std::vector<double> values;
  std::size_t diverged = 0;
  std::size_t valid = 0;
  for (std::size_t i = 0; i < runs.size(); ++i) {
    if (!runs[i].invalid.empty()) continue;
    ++valid;
    auto value = counted(objective, runs[i], i < reference.size() ? &reference[i] : nullptr);
    if (runs[i].diverged) {
      ++diverged;
      const double penalty = objective.divergence_penalty;
      value = std::max(value.value_or(penalty > 0.0 ? penalty : kWithoutScore), penalty);
    }
    if (value) values.push_back(*value);
  }
  const auto statistic = statistic_of(objective, values);
  if (!statistic) return std::nullopt;
  return *statistic + objective.divergence_penalty * static_cast<double>(diverged) / double(valid);
}

std::vector<std::size_t> cases_of(const ResponseTable& table, const std::string& family) {
  const std::vector<bool> common = common_cases(table);
  std::vector<std::size_t> indices;
  for (std::size_t i = 0; i < table.cases.size(); ++i) {
    if (!family.empty() && table.cases[i].family != family) continue;
    if (common[i]) indices.push_back(i);
  }
  return indices;
}

SeedGroups cases_by_seed(const ResponseTable& table, std::span<const std::size_t> cases) {
  std::map<std::uint64_t, std::vector<std::size_t>> seeds;
  for (const std::size_t i : cases) seeds[table.cases[i].seed].push_back(i);
  SeedGroups groups;
  for (auto& [seed, group] : seeds) {
    std::ranges::sort(group, {}, [&](std::size_t i) { return table.cases[i].scenario; });
    groups.push_back(std::move(group));
  }
  return groups;
}

std::vector<std::size_t> joined(const SeedGroups& groups, std::span<const std::size_t> drawn) {
  std::vector<std::size_t> cases;
  for (const std::size_t i : drawn) cases.insert(cases.end(), groups[i].begin(), groups[i].end());
  return cases;
}

std::vector<std::size_t> distinct_points(const ResponseTable& table) {
  std::set<std::vector<double>> known;
  std::vector<std::size_t> points;
  for (std::size_t k = 0; k < table.points.size(); ++k) {
    if (known.insert(table.points[k]).second) points.push_back(k);
  }
  return points;
}

std::size_t other_points(const ResponseTable& table) {
  const auto points = distinct_points(table);
  return static_cast<std::size_t>(std::ranges::count_if(
      points, [&](std::size_t k) { return table.points[k] != table.defaults; }));
}

std::vector<std::string> families_of(const ResponseTable& table) {
  std::vector<std::string> families;
  for (const std::size_t i : cases_of(table, "")) append_new(families, table.cases[i].family);
  return families;
}

namespace {

/// "python:mine.Mine: ... ValueError: x" of a text with a traceback in it.
std::string ends_of(const std::string& text) {
  const auto first = text.find('\n');
  if (first == std::string::npos) return text;
  const auto end = text.find_last_not_of(" \n");
  const auto last = text.rfind('\n', end);
  const auto begin = text.find_first_not_of(' ', last + 1);
  return fmt::format("{} ... {}", text.substr(0, first), text.substr(begin, end + 1 - begin));
}

/// A line per case with runs for which `reason_of` gives a reason: "CASE: N of M runs WHAT
/// (REASON)".
template <class ReasonOf>
std::vector<std::string> lines_of(const ResponseTable& table, const char* what,
                                  ReasonOf&& reason_of) {
  std::vector<std::string> lines;
  for (std::size_t i = 0; i < table.cases.size(); ++i) {
    std::size_t runs = 0;
    std::size_t counted = 0;
    std::string reason;
    const auto look_at = [&](const std::vector<RunScore>& of_point) {
      if (i >= of_point.size()) return;
      ++runs;
      const std::string& of_run = reason_of(of_point[i]);
      if (of_run.empty()) return;
      ++counted;
      reason = of_run;
    };
    const bool is_point = std::ranges::find(table.points, table.defaults) != table.points.end();
    if (!is_point) look_at(table.default_runs);
    for (const auto& of_point : table.runs) look_at(of_point);
    if (counted == 0) continue;
    lines.push_back(fmt::format("{} seed {}: {} of {} runs {} ({})", table.cases[i].scenario,
                                table.cases[i].seed, counted, runs, what, ends_of(reason)));
  }
  return lines;
}

}  // namespace

std::vector<std::string> left_out_lines(const ResponseTable& table) {
  auto lines = lines_of(table, "are invalid and left out",
                        [](const RunScore& run) -> const std::string& { return run.invalid; });
  if (const std::size_t common = cases_of(table, "").size(); !lines.empty()) {
    lines.push_back(fmt::format(
        "points are compared on the {} of {} sequences on which each has a valid run, without "
        "points that have one on fewer than half",
        common, table.cases.size()));
  }
  return lines;
}

std::vector<std::string> failed_lines(const ResponseTable& table) {
  return lines_of(table, "failed",
                  [](const RunScore& run) -> const std::string& { return run.failure; });
}

bool all_diverged(const ResponseTable& table) {
  const auto diverged = [](const std::vector<RunScore>& runs) {
    return std::ranges::all_of(
        runs, [](const RunScore& run) { return run.diverged || !run.invalid.empty(); });
  };
  return diverged(table.default_runs) && std::ranges::all_of(table.runs, diverged);
}

bool defaults_all_diverged(const ResponseTable& table) {
  std::size_t diverged = 0;
  for (const RunScore& run : table.default_runs) {
    if (!run.invalid.empty()) continue;
    if (!run.diverged) return false;
    ++diverged;
  }
  return diverged > 0;
}

std::vector<std::uint64_t> seeds_of(const ResponseTable& table) {
  std::vector<std::uint64_t> seeds;
  for (const std::size_t i : cases_of(table, "")) append_new(seeds, table.cases[i].seed);
  return seeds;
}

const std::vector<RunScore>& runs_at(const ResponseTable& table, std::size_t point) {
  return point == kDefaults ? table.default_runs : table.runs[point];
}

const std::vector<double>& values_at(const ResponseTable& table, std::size_t point) {
  return point == kDefaults ? table.defaults : table.points[point];
}

std::optional<double> objective_at(const ResponseTable& table, const Objective& objective,
                                   std::size_t point, std::span<const std::size_t> cases) {
  const auto& all = runs_at(table, point);
  if (all.empty()) return std::nullopt;
  std::vector<RunScore> runs;
  std::vector<RunScore> reference;
  for (const std::size_t i : cases) {
    if (!all[i].invalid.empty()) return std::nullopt;  // others are valid there
    runs.push_back(all[i]);
    if (!table.default_runs.empty()) reference.push_back(reference_at(table, i));
  }
  return objective_value(objective, runs, reference);
}

std::optional<double> gain_over(const std::optional<double>& defaults,
                                const std::optional<double>& best) {
  if (!defaults || !best || !(*defaults > 0.0)) return std::nullopt;
  return 1.0 - *best / *defaults;
}

Result<void> check_direction(const std::string& key, const std::string& score) {
  if (better_of(score) == Better::kSmaller) return {};
  return failure(
      fmt::format("{}: less of '{}' is not better, and objectives are minimized; expected a score "
                  "of which less is better, e.g. ate_yaw_m",
                  key, score));
}

Objective objective_for(Objective objective, const ResponseTable& table) {
  if (!objective.relative) return objective;
  const auto& defaults = table.default_runs;
  for (const std::size_t i : cases_of(table, "")) {
    if (i >= defaults.size()) continue;
    const RunScore& run = defaults[i];
    objective.without_ratio = objective.without_ratio || (run.value && !(*run.value > 0.0));
    objective.lost_defaults = objective.lost_defaults || (!run.value && run.diverged);
  }
  objective.relative = !defaults.empty() && !objective.without_ratio;
  return objective;
}

}  // namespace aims
