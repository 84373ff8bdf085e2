// SPDX-License-Identifier: BSD-3-Clause
#include "bench/run/expectations.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <string_view>
#include <utility>

#include "bench/metrics/statistics.hpp"
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
  check.value = expectation.statistic == ExpectationStatistic::kMedian ? median(values) : mean(values);
  for (const RunRecord& run : runs) check.seeds.push_back(run.seed);
}

ExpectationCheck check_one(const Expectation& expectation, std::span<const RunRecord> runs) {
  ExpectationCheck check;
  check.expectation = expectation;
  std::vector<double> values;
  for (const RunRecord& run : runs) {
    if (const auto value = find_score(run, expectation.estimator, expectation.score)) {
      values.push_back(*value);
    } else {
      check.seeds.push_back(run.seed);
    }
  }
  if (values.size() < runs.size()) return check;
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

/// The word as a POSIX shell reads it back.
std::string quoted(const std::string& word) {
  const auto is_plain = [](char c) {
    return std::isalnum(static_cast<unsigned char>(c)) != 0 ||
           std::string_view("-_./=,:+@%").find(c) != std::string_view::npos;
  };
  if (!word.empty() && std::all_of(word.begin(), word.end(), is_plain)) return word;
  std::string text = "'";
  for (const char c : word) text += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return text + "'";
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

std::vector<ExpectationCheck> check_expectations(const Scenario& scenario, std::span<const RunRecord> runs) {
  std::vector<ExpectationCheck> checks;
  if (runs.empty()) return checks;
  for (const Expectation& expectation : scenario.expect) {
    const auto ran = labels_of(scenario.run);
    if (std::find(ran.begin(), ran.end(), expectation.estimator) == ran.end()) continue;
    checks.push_back(check_one(expectation, runs));
  }
  return checks;
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
  return fmt::format("{} seed {}: {} {}{} = {}, expected {}", scenario.name,
                     fmt::join(check.seeds, ","), check.expectation.estimator, statistic,
                     check.expectation.score, value, limits_of(check.expectation));
}

std::string reproducing_command(const Scenario& scenario, const ExpectationCheck& check) {
  const std::string file = scenario.file.empty() ? scenario.name : scenario.file.string();
  const auto asked =
      std::find_if(scenario.run.begin(), scenario.run.end(),
                   [&](const auto& spec) { return label_of(spec) == check.expectation.estimator; });
  const bool found = asked != scenario.run.end();
  std::string command = fmt::format("aims run {} --seeds {} --estimators {}", quoted(file),
                                    fmt::join(check.seeds, ","),
                                    quoted(found ? *asked : check.expectation.estimator));
  for (const std::string& setting : scenario.overrides) {
    if (applies(setting, scenario, found ? *asked : check.expectation.estimator)) {
      command += " --set " + quoted(setting);
    }
  }
  return command;
}

}  // namespace aims
