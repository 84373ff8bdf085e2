// SPDX-License-Identifier: BSD-3-Clause
#include "bench/run/expectations.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <string_view>
#include <utility>

#include "bench/metrics/statistics.hpp"
#include "bench/scoring/score_statistics.hpp"
#include "core/text.hpp"
#include "estimator/estimator_spec.hpp"

namespace aims {
namespace {

bool within(const Expectation& expectation, double value) {
  return expectation.min <= value && value <= expectation.max;
}

/// How far a value is beyond the limits; negative inside.
double excess(const Expectation& expectation, double value) {
  return std::max(value - expectation.max, expectation.min - value);
}

/// Fills value and seeds from the scores of all runs, one per run.
void apply_statistic(std::span<const RunRecord> runs, const std::vector<double>& values,
                     ExpectationCheck& check) {
  const Expectation& expectation = check.expectation;
  if (expectation.statistic == ExpectationStatistic::kWorst) {
    const auto worst = std::max_element(values.begin(), values.end(), [&](double a, double b) {
      return excess(expectation, a) < excess(expectation, b);
    });
    check.value = *worst;
    check.seeds = {runs[static_cast<std::size_t>(worst - values.begin())].seed};
    return;
  }
  check.value =
      expectation.statistic == ExpectationStatistic::kMedian ? median(values) : mean(values);
  for (const RunRecord& run : runs) check.seeds.push_back(run.seed);
}

/// Whether it is an error or a success of the estimate, which a part of a run has not.
bool is_accuracy(const std::string& score) {
  const bool success = score.starts_with(kSuccessKey) ||
                       score.starts_with(std::string(kOptimizedPrefix) + kSuccessKey);
  return success || (better_of(score) == Better::kSmaller && !is_timing(score) &&
                     !score.starts_with("health."));
}

std::optional<double> value_of(const RunRecord& run, const Expectation& expectation) {
  const std::string& estimator = expectation.estimator;
  const std::string& score = expectation.score;
  if (estimator.empty()) return find_run_score(run, score);
  return is_accuracy(score) ? compared_score(run, estimator, score)
                            : find_score(run, estimator, score);
}

ExpectationCheck check_one(const Expectation& expectation, std::span<const RunRecord> runs) {
  ExpectationCheck check;
  check.expectation = expectation;
  std::vector<double> values;
  for (const RunRecord& run : runs) {
    if (const auto value = value_of(run, expectation)) {
      values.push_back(*value);
    } else {
      check.seeds.push_back(run.seed);
    }
  }
  if (values.empty() || values.size() < runs.size()) return check;
  apply_statistic(runs, values, check);
  check.holds = within(expectation, *check.value);
  return check;
}

std::string limits_of(const Expectation& expectation) {
  if (expectation.min == -kNoLimit) return fmt::format("at most {:g}", expectation.max);
  if (expectation.max == kNoLimit) return fmt::format("at least {:g}", expectation.min);
  return fmt::format("from {:g} to {:g}", expectation.min, expectation.max);
}

std::string_view name_of(ExpectationStatistic statistic) {
  if (statistic == ExpectationStatistic::kMedian) return "median";
  return statistic == ExpectationStatistic::kMean ? "mean" : "worst";
}

/// Whether the check demands of the run what made it invalid.
bool demands_invalid(const ExpectationCheck& check, const RunRecord& run) {
  const Expectation& expectation = check.expectation;
  if (!expectation.estimator.empty() || !check.holds) return false;
  const auto has = [&](const char* score, double value_of_valid) {
    return expectation.score == score && !within(expectation, value_of_valid);
  };
  const bool fell = find_run_score(run, "robot.fell") == 1.0;
  const bool leaned =
      find_run_score(run, "robot.wall_contact_fraction").value_or(0.0) > kMaxWallContact;
  return has("robot.valid", 1.0) || (fell && has("robot.fell", 0.0)) ||
         (!fell && leaned && has("robot.wall_contact_fraction", kMaxWallContact));
}

/// Copies of the valid ones.
std::vector<RunRecord> valid_ones(std::span<const RunRecord> runs) {
  std::vector<RunRecord> valid;
  std::ranges::copy_if(runs, std::back_inserter(valid), is_valid_run);
  return valid;
}

/// Whether a setting of the scenario has an effect where `spec` alone runs.
bool applies(const std::string& setting, const Scenario& scenario, const std::string& spec) {
  if (is_run_setting(setting)) return false;
  if (!setting.starts_with("estimators.")) return true;
  Scenario alone = scenario;
  alone.run = {spec};
  const std::string key = setting.substr(0, setting.find('='));
  return check_effect(fields_of(alone), std::vector<AssignedKey>{{key, ""}}).has_value();
}

}  // namespace

std::vector<ExpectationCheck> check_expectations(const Scenario& scenario,
                                                 std::span<const RunRecord> runs) {
  std::vector<ExpectationCheck> checks;
  if (runs.empty()) return checks;
  const std::vector<RunRecord> valid = valid_ones(runs);
  const auto ran = labels_of(scenario.run);
  for (const Expectation& expectation : scenario.expect) {
    if (expectation.estimator.empty()) {
      checks.push_back(check_one(expectation, runs));
    } else if (std::find(ran.begin(), ran.end(), expectation.estimator) != ran.end()) {
      checks.push_back(check_one(expectation, valid));
    }
  }
  return checks;
}

std::vector<InvalidRun> undemanded_runs(std::span<const RunRecord> runs,
                                        std::span<const ExpectationCheck> checks) {
  std::vector<InvalidRun> undemanded;
  for (const RunRecord& run : runs) {
    auto reason = invalid_reason(run.scores);
    const bool demanded = std::ranges::any_of(
        checks, [&](const ExpectationCheck& check) { return demands_invalid(check, run); });
    if (reason && !demanded) undemanded.push_back({run.seed, std::move(*reason)});
  }
  return undemanded;
}

std::vector<ExpectationCheck> failed(std::vector<ExpectationCheck> checks) {
  std::erase_if(checks, [](const ExpectationCheck& check) { return check.holds; });
  return checks;
}

Json check_json(const ExpectationCheck& check) {
  const Expectation& expectation = check.expectation;
  return {{"estimator", expectation.estimator},
          {"score", expectation.score},
          {"statistic", name_of(expectation.statistic)},
          {"max", expectation.max == kNoLimit ? Json() : Json(expectation.max)},
          {"min", expectation.min == -kNoLimit ? Json() : Json(expectation.min)},
          {"value", json_of(check.value)},
          {"seeds", check.seeds},
          {"holds", check.holds}};
}

std::string text_of(const Scenario& scenario, const ExpectationCheck& check) {
  const std::string value = check.value ? fmt::format("{:.4g}", *check.value) : "no value";
  std::string statistic(name_of(check.expectation.statistic));
  statistic = check.expectation.statistic == ExpectationStatistic::kWorst ? "" : statistic + " ";
  if (!check.expectation.estimator.empty())
    statistic = check.expectation.estimator + " " + statistic;
  const std::string runs =
      check.seeds.empty() ? "no valid run" : fmt::format("seed {}", fmt::join(check.seeds, ","));
  return fmt::format("{} {}: {}{} = {}, expected {}", scenario.name, runs, statistic,
                     check.expectation.score, value, limits_of(check.expectation));
}

std::string reproducing_command(const Scenario& scenario, const ExpectationCheck& check) {
  const std::string file = scenario.file.empty() ? scenario.name : scenario.file.string();
  const std::string& label = check.expectation.estimator;
  const auto asked =
      std::ranges::find_if(scenario.run, [&](const auto& spec) { return label_of(spec) == label; });
  std::string command = fmt::format("aims run {}", shell_word(file));
  if (!check.seeds.empty()) command += fmt::format(" --seeds {}", fmt::join(check.seeds, ","));
  const std::string spec = asked != scenario.run.end() ? *asked : label;
  if (!spec.empty()) command += " --estimators " + shell_word(spec);
  for (const std::string& setting : scenario.overrides) {
    const bool kept = spec.empty() ? !is_run_setting(setting) : applies(setting, scenario, spec);
    if (kept) command += " --set " + shell_word(setting);
  }
  return command;
}

}  // namespace aims
