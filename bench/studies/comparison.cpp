// SPDX-License-Identifier: BSD-3-Clause
#include "bench/studies/comparison.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>
#include <map>
#include <set>

#include "bench/metrics/statistics.hpp"
#include "bench/studies/suite_summary.hpp"
#include "core/random.hpp"

namespace aims {
namespace {

constexpr double kLeastShare = 0.05;  ///< of the value before
constexpr std::size_t kMostSignings = 64;
constexpr int kReplicates = 400;

const HeadlineScore kSuccess = {"success", "success", "-", 2, 0.0};

/// Paired values of one score over the common seeds.
struct Pairs {
  std::vector<double> before;
  std::vector<double> after;
};

bool has(const RunRecord& run, const std::string& estimator) {
  return run.scores["estimators"].contains(estimator);
}

Pairs pairs_of(const std::vector<RunRecord>& before, const std::vector<RunRecord>& after,
               const std::string& estimator, const char* key) {
  Pairs pairs;
  for (const RunRecord& a : before) {
    for (const RunRecord& b : after) {
      if (a.seed != b.seed || !has(a, estimator) || !has(b, estimator)) continue;
      const auto old_value = find_score(a, estimator, key);
      const auto new_value = find_score(b, estimator, key);
      if (!old_value || !new_value) continue;
      pairs.before.push_back(*old_value);
      pairs.after.push_back(*new_value);
    }
  }
  return pairs;
}

Interval mean_interval(const std::vector<double>& values) {
  return bootstrap_interval(
      values.size(),
      [&](std::span<const std::size_t> drawn) {
        double sum = 0.0;
        for (const std::size_t index : drawn) sum += values[index];
        return std::optional<double>(sum / static_cast<double>(drawn.size()));
      },
      1, kReplicates);
}

/// The rule that says better or worse.
bool speaks(const std::vector<double>& differences, double floor) {
  if (std::abs(*mean(differences)) <= floor) return false;
  const Interval interval = mean_interval(differences);
  return interval.low && (*interval.low > 0.0 || *interval.high < 0.0);
}

/// Share of all signings of the differences (or of 64 draws, when there are more) for which the
/// rule speaks.
double false_alarm(const std::vector<double>& differences, double floor) {
  if (differences.size() < 2) return 0.0;
  const double largest =
      std::abs(*std::max_element(differences.begin(), differences.end(),
                                 [](double a, double b) { return std::abs(a) < std::abs(b); }));
  if (largest <= floor) return 0.0;
  const bool all = differences.size() <= 6;
  const std::size_t signings = all ? std::size_t{1} << differences.size() : kMostSignings;
  RandomStream random = rng(1, "compare.signs");
  std::size_t spoken = 0;
  for (std::size_t signing = 0; signing < signings; ++signing) {
    std::vector<double> signed_differences = differences;
    for (std::size_t i = 0; i < differences.size(); ++i) {
      const bool flip = all ? (signing >> i & 1U) != 0 : random.chance(0.5);
      if (flip) signed_differences[i] = -signed_differences[i];
    }
    spoken += speaks(signed_differences, floor);
  }
  return static_cast<double>(spoken) / static_cast<double>(signings);
}

ChangeVerdict verdict_of(const std::vector<double>& differences, double floor,
                         bool more_is_better) {
  const double change = *mean(differences);
  if (differences.size() == 1) {
    return std::abs(change) > floor ? ChangeVerdict::kUnknown : ChangeVerdict::kNone;
  }
  if (!speaks(differences, floor)) return ChangeVerdict::kNone;
  return (change > 0.0) == more_is_better ? ChangeVerdict::kBetter : ChangeVerdict::kWorse;
}

ScoreChange change_of(const Pairs& pairs, const HeadlineScore& score) {
  const bool success = score.key == kSuccess.key;
  ScoreChange change;
  change.score = score.key;
  change.seeds = pairs.before.size();
  change.before = success ? *mean(pairs.before) : *median(pairs.before);
  change.after = success ? *mean(pairs.after) : *median(pairs.after);
  std::vector<double> differences(pairs.before.size());
  std::transform(pairs.after.begin(), pairs.after.end(), pairs.before.begin(), differences.begin(),
                 std::minus<>());
  change.change = *mean(differences);
  change.interval = mean_interval(differences);
  const double floor = success ? 0.0 : std::max(score.floor, kLeastShare * std::abs(change.before));
  change.verdict = verdict_of(differences, floor, success);
  change.false_alarm = false_alarm(differences, floor);
  return change;
}

/// Seeds by "scenario, estimator".
using Units = std::map<std::string, std::set<std::uint64_t>>;

Units units_of(const StoredResults& results) {
  Units units;
  for (const auto& [scenario, runs] : results) {
    for (const RunRecord& run : runs) {
      for (const auto& [estimator, unused] : run.scores["estimators"].items()) {
        units[scenario + ", " + estimator].insert(run.seed);
      }
    }
  }
  return units;
}

/// What `units` has and `others` has not.
std::vector<std::string> without(const Units& units, const Units& others) {
  std::vector<std::string> rest;
  for (const auto& [name, seeds] : units) {
    const auto other = others.find(name);
    std::vector<std::uint64_t> missing;
    for (const std::uint64_t seed : seeds) {
      if (other == others.end() || !other->second.contains(seed)) missing.push_back(seed);
    }
    if (missing.empty()) continue;
    rest.push_back(fmt::format("{}, seed {}", name, fmt::join(missing, ",")));
  }
  return rest;
}

/// Adds the changes of one scenario.
void compare_runs(const std::string& scenario, const std::vector<RunRecord>& before,
                  const std::vector<RunRecord>& after, Comparison& comparison) {
  std::set<std::string> estimators;
  for (const RunRecord& run : before) {
    for (const auto& [name, unused] : run.scores["estimators"].items()) estimators.insert(name);
  }
  std::vector<HeadlineScore> scores(kHeadlineScores.begin(), kHeadlineScores.end());
  scores.push_back(kSuccess);
  for (const std::string& estimator : estimators) {
    for (const HeadlineScore& score : scores) {
      const Pairs pairs = pairs_of(before, after, estimator, score.key);
      if (pairs.before.empty()) continue;
      ScoreChange change = change_of(pairs, score);
      change.scenario = scenario;
      change.estimator = estimator;
      comparison.expected_false_alarms += change.false_alarm;
      comparison.changes.push_back(std::move(change));
    }
  }
}

}  // namespace

Comparison compare(const StoredResults& before, const StoredResults& after) {
  Comparison comparison;
  for (const auto& [scenario, runs] : before) {
    const auto other = after.find(scenario);
    if (other != after.end()) compare_runs(scenario, runs, other->second, comparison);
  }
  const Units units_before = units_of(before);
  const Units units_after = units_of(after);
  comparison.only_before = without(units_before, units_after);
  comparison.only_after = without(units_after, units_before);
  return comparison;
}

std::size_t count(const Comparison& comparison, ChangeVerdict verdict) {
  return static_cast<std::size_t>(
      std::count_if(comparison.changes.begin(), comparison.changes.end(),
                    [&](const ScoreChange& change) { return change.verdict == verdict; }));
}

}  // namespace aims
