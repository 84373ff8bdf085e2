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
#include "core/random.hpp"

namespace aims {
namespace {

constexpr double kMinChange = 0.05;  ///< fraction of the value before
constexpr std::size_t kMaxSignings = 64;

const HeadlineScore kSuccess = {"success", "success", "-", 2, 0.0};

/// The rule for better or worse.
bool is_significant(const std::vector<double>& differences, double floor) {
  if (std::abs(*mean(differences)) <= floor) return false;
  const Interval interval = mean_interval(differences);
  return interval.low && (*interval.low > 0.0 || *interval.high < 0.0);
}

/// Fraction of all signings of the differences (or of 64 draws, when there are more) that the rule
/// finds significant.
double false_alarm(const std::vector<double>& differences, double floor) {
  if (differences.size() < 2) return 0.0;
  const double largest =
      std::abs(*std::max_element(differences.begin(), differences.end(),
                                 [](double a, double b) { return std::abs(a) < std::abs(b); }));
  if (largest <= floor) return 0.0;
  const bool all = differences.size() <= 6;
  const std::size_t signings = all ? std::size_t{1} << differences.size() : kMaxSignings;
  RandomStream random = rng(1, "compare.signs");
  std::size_t found = 0;
  for (std::size_t signing = 0; signing < signings; ++signing) {
    std::vector<double> signed_differences = differences;
    for (std::size_t i = 0; i < differences.size(); ++i) {
      const bool flip = all ? (signing >> i & 1U) != 0 : random.chance(0.5);
      if (flip) signed_differences[i] = -signed_differences[i];
    }
    found += is_significant(signed_differences, floor);
  }
  return static_cast<double>(found) / static_cast<double>(signings);
}

ChangeVerdict verdict_of(const std::vector<double>& differences, double floor,
                         bool more_is_better) {
  const double change = *mean(differences);
  if (differences.size() == 1) {
    return std::abs(change) > floor ? ChangeVerdict::kUnknown : ChangeVerdict::kNone;
  }
  if (!is_significant(differences, floor)) return ChangeVerdict::kNone;
  return (change > 0.0) == more_is_better ? ChangeVerdict::kBetter : ChangeVerdict::kWorse;
}

ScoreChange change_of(const ScorePairs& pairs, const HeadlineScore& score) {
  const bool success = score.key == kSuccess.key;
  ScoreChange change;
  change.score = score.key;
  change.pairs = statistics_of(pairs);
  change.before = success ? *mean(pairs.reference) : *change.pairs.reference_median;
  change.after = success ? *mean(pairs.value) : *change.pairs.median;
  const std::vector<double> differences = pairs.differences();
  const double floor = success ? 0.0 : std::max(score.floor, kMinChange * std::abs(change.before));
  change.verdict = verdict_of(differences, floor, success);
  change.false_alarm = false_alarm(differences, floor);
  return change;
}

/// Seeds by "scenario, estimator".
using SeedsByName = std::map<std::string, std::set<std::uint64_t>>;

SeedsByName seeds_of(const StoredResults& results) {
  SeedsByName seeds;
  for (const auto& [scenario, runs] : results) {
    for (const RunRecord& run : runs) {
      for (const auto& [estimator, unused] : run.scores["estimators"].items()) {
        seeds[scenario + ", " + estimator].insert(run.seed);
      }
    }
  }
  return seeds;
}

/// What `ours` has and `others` has not.
std::vector<std::string> without(const SeedsByName& ours, const SeedsByName& others) {
  std::vector<std::string> rest;
  for (const auto& [name, seeds] : ours) {
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
      const ScorePairs pairs = paired({before, estimator}, {after, estimator}, score.key);
      if (pairs.value.empty()) continue;
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
  const SeedsByName seeds_before = seeds_of(before);
  const SeedsByName seeds_after = seeds_of(after);
  comparison.only_before = without(seeds_before, seeds_after);
  comparison.only_after = without(seeds_after, seeds_before);
  return comparison;
}

std::size_t count(const Comparison& comparison, ChangeVerdict verdict) {
  return static_cast<std::size_t>(
      std::count_if(comparison.changes.begin(), comparison.changes.end(),
                    [&](const ScoreChange& change) { return change.verdict == verdict; }));
}

}  // namespace aims
