// SPDX-License-Identifier: BSD-3-Clause
#include "bench/studies/comparison.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>
#include <set>

#include "bench/metrics/statistics.hpp"
#include "bench/scoring/score_statistics.hpp"
#include "bench/scoring/validity.hpp"

namespace aims {
namespace {

constexpr double kSuccessLevel = 0.05;  ///< of McNemar's test

/// Differences up to this fraction of what matters are of rounding.
constexpr double kRounding = 1e-4;

ChangeVerdict verdict_of(const std::vector<double>& differences, const PairedTest& test,
                         double floor) {
  if (std::ranges::all_of(differences,
                          [&](double each) { return std::abs(each) <= kRounding * floor; })) {
    return ChangeVerdict::kSame;
  }
  if (differences.size() < kFewestPairs) return ChangeVerdict::kTooFew;
  if (!test.found()) return ChangeVerdict::kNone;
  if (std::abs(test.change) <= floor) return ChangeVerdict::kSmall;
  return test.change < 0.0 ? ChangeVerdict::kBetter : ChangeVerdict::kWorse;
}

/// What pairs have whatever the score.
ScoreChange means_of(const ScorePairs& pairs, const char* key) {
  ScoreChange change;
  change.score = key;
  change.pairs = pairs.value.size();
  change.before = *mean(pairs.reference);
  change.after = *mean(pairs.value);
  return change;
}

ScoreChange change_of(const ScorePairs& pairs, const Score& score) {
  const std::vector<double> differences = pairs.differences();
  ScoreChange change = means_of(pairs, score.key);
  change.worst_after = *std::ranges::max_element(pairs.value);
  change.floor = smallest_change(score.key, change.before);
  change.test = paired_test(differences);
  change.verdict = verdict_of(differences, change.test, change.floor);
  change.false_alarm = false_alarm_rate(differences, change.floor);
  return change;
}

ScoreChange success_change_of(const ScorePairs& pairs, const Score& score) {
  ScoreChange change = means_of(pairs, score.key);
  change.worst_after = *std::ranges::min_element(pairs.value);
  std::size_t lost = 0;
  std::size_t won = 0;
  for (const double difference : pairs.differences()) {
    lost += difference < 0.0;
    won += difference > 0.0;
  }
  change.success = mcnemar_test(lost, won);
  change.test.change = change.after - change.before;
  change.test.p = change.success->p;
  change.false_alarm = mcnemar_false_alarm(lost + won);
  if (lost + won == 0) {
    change.verdict = ChangeVerdict::kSame;
  } else if (change.pairs < kFewestPairs) {
    change.verdict = ChangeVerdict::kTooFew;
  } else if (change.test.p <= kSuccessLevel) {
    change.verdict = won > lost ? ChangeVerdict::kBetter : ChangeVerdict::kWorse;
  }
  return change;
}

/// Seeds by "scenario, estimator".
using SeedsByName = std::map<std::string, std::set<std::uint64_t>>;

/// Those of the runs of which it holds.
template <class Holds>
SeedsByName seeds_where(const StoredResults& results, Holds&& holds) {
  SeedsByName seeds;
  for (const auto& [scenario, runs] : results) {
    for (const RunRecord& run : runs) {
      for (const std::string& estimator : estimators_in({&run, 1})) {
        if (holds(run, estimator)) seeds[scenario + ", " + estimator].insert(run.seed);
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

/// What both have.
SeedsByName common(SeedsByName ours, const SeedsByName& others) {
  for (auto& [name, seeds] : ours) {
    const auto other = others.find(name);
    std::erase_if(seeds, [&](std::uint64_t seed) {
      return other == others.end() || !other->second.contains(seed);
    });
  }
  return ours;
}

/// Adds the changes of one scenario.
void compare_runs(const std::string& scenario, const std::vector<RunRecord>& before,
                  const std::vector<RunRecord>& after, Comparison& comparison) {
  std::vector<std::string> estimators = estimators_in(before);
  std::ranges::sort(estimators);
  for (const std::string& estimator : estimators) {
    const auto add = [&](const auto& score, const auto& changed) {
      const ScorePairs pairs = paired({before, estimator}, {after, estimator}, score.key);
      if (pairs.value.empty()) return;
      ScoreChange change = changed(pairs, score);
      change.scenario = scenario;
      change.estimator = estimator;
      comparison.expected_false_alarms += change.false_alarm;
      comparison.changes.push_back(std::move(change));
    };
    for (const Score& score : headline_scores()) add(score, change_of);
    for (const Score& score : success_scores()) add(score, success_change_of);
  }
}

/// Notes the runs of one side that are left out.
void note_invalid(const char* side, const StoredResults& results, Comparison& comparison) {
  for (const auto& [scenario, runs] : results) {
    for (const auto& [seed, reason] : invalid_runs(runs)) {
      comparison.invalid.push_back(fmt::format("{}: {} seed {}: {}", side, scenario, seed, reason));
    }
  }
}

/// Notes the estimates of one side that leave a part of the run out.
void note_partial(const char* side, const StoredResults& results, const SeedsByName& others,
                  Comparison& comparison) {
  const SeedsByName partial =
      common(seeds_where(results,
                         [](const RunRecord& run, const std::string& estimator) {
                           return is_partial(run, estimator) && !failed_in(run, estimator);
                         }),
             others);
  for (const auto& [name, seeds] : partial) {
    if (seeds.empty()) continue;
    comparison.partial.push_back(fmt::format("{}: {}, seed {}", side, name, fmt::join(seeds, ",")));
  }
}

/// What tells one sequence of a scenario and seed from another; null where it is not known.
Json sequence_of(const RunRecord& run) {
  Json parts = Json::object();
  for (const char* key : {"simulated_s", "segments"}) {
    if (run.scores.contains(key)) parts[key] = run.scores[key];
  }
  return parts.empty() ? Json() : parts;
}

const RunRecord* run_of(const std::vector<RunRecord>& runs, std::uint64_t seed) {
  const auto found = std::ranges::find(runs, seed, &RunRecord::seed);
  return found == runs.end() ? nullptr : &*found;
}

/// Notes where the two sides are not results of one task or one estimator.
void note_others(const std::string& scenario, const std::vector<RunRecord>& before,
                 const std::vector<RunRecord>& after, Comparison& comparison) {
  std::vector<std::uint64_t> seeds;
  for (const RunRecord& run : before) {
    const RunRecord* other = run_of(after, run.seed);
    if (other == nullptr) continue;
    const Json ours = sequence_of(run), theirs = sequence_of(*other);
    if (!ours.is_null() && !theirs.is_null() && ours != theirs) seeds.push_back(run.seed);
    for (const auto& [label, spec] : run.specs) {
      const auto theirs_of = other->specs.find(label);
      if (theirs_of == other->specs.end() || theirs_of->second == spec) continue;
      std::string line = fmt::format("{}: {} before, {} after", label, spec, theirs_of->second);
      if (std::ranges::find(comparison.other_specs, line) == comparison.other_specs.end()) {
        comparison.other_specs.push_back(std::move(line));
      }
    }
  }
  if (seeds.empty()) return;
  comparison.other_sequences.push_back(fmt::format("{}, seed {}", scenario, fmt::join(seeds, ",")));
}

}  // namespace

Comparison compare(const StoredResults& before, const StoredResults& after) {
  Comparison comparison;
  for (const auto& [scenario, runs] : before) {
    const auto other = after.find(scenario);
    if (other == after.end()) continue;
    compare_runs(scenario, runs, other->second, comparison);
    note_others(scenario, runs, other->second, comparison);
  }
  note_invalid("before", before, comparison);
  note_invalid("after", after, comparison);
  const auto ran = [](const RunRecord&, const std::string&) { return true; };
  const SeedsByName seeds_before = seeds_where(before, ran);
  const SeedsByName seeds_after = seeds_where(after, ran);
  comparison.only_before = without(seeds_before, seeds_after);
  comparison.only_after = without(seeds_after, seeds_before);
  const auto valid = [](const RunRecord& run, const std::string&) { return is_valid_run(run); };
  const SeedsByName valid_after = seeds_where(after, valid);
  for (const auto& [name, seeds] : seeds_where(before, valid)) {
    const auto other = valid_after.find(name);
    const auto is_common = [&](std::uint64_t seed) { return other->second.contains(seed); };
    if (other == valid_after.end() || std::ranges::none_of(seeds, is_common)) {
      comparison.not_compared.push_back(name);
    }
  }
  const auto failed = [](const RunRecord& run, const std::string& estimator) {
    return is_valid_run(run) && failed_in(run, estimator);
  };
  const SeedsByName failed_before = seeds_where(before, failed);
  const SeedsByName failed_after = seeds_where(after, failed);
  comparison.fails_now = without(common(failed_after, seeds_before), failed_before);
  comparison.fails_no_more = without(common(failed_before, seeds_after), failed_after);
  note_partial("before", before, seeds_after, comparison);
  note_partial("after", after, seeds_before, comparison);
  return comparison;
}

std::size_t count(const Comparison& comparison, ChangeVerdict verdict) {
  return static_cast<std::size_t>(
      std::count_if(comparison.changes.begin(), comparison.changes.end(),
                    [&](const ScoreChange& change) { return change.verdict == verdict; }));
}

}  // namespace aims
