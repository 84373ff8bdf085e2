// SPDX-License-Identifier: BSD-3-Clause
#include "bench/scoring/score_statistics.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>

#include "bench/metrics/statistics.hpp"
#include "bench/scoring/score_list.hpp"
#include "bench/scoring/validity.hpp"

namespace aims {
namespace {

/// Of the resampling: one seed, so that a table can be repeated.
constexpr std::uint64_t kBootstrapSeed = 1;
constexpr int kMeanReplicates = 400;

std::vector<double> values_of(std::span<const RunRecord> runs, const std::string& estimator,
                              const std::string& key) {
  std::vector<double> values;
  for (const RunRecord& run : runs) {
    if (!is_valid_run(run)) continue;
    if (const auto value = find_score(run, estimator, key)) values.push_back(*value);
  }
  return values;
}

}  // namespace

bool any_partial(std::span<const RunRecord> runs, const std::string& estimator) {
  return std::ranges::any_of(runs,
                             [&](const RunRecord& run) { return is_partial(run, estimator); });
}

std::size_t failed_runs(std::span<const RunRecord> runs, const std::string& estimator) {
  return static_cast<std::size_t>(std::ranges::count_if(
      runs, [&](const RunRecord& run) { return is_valid_run(run) && failed_in(run, estimator); }));
}

std::vector<std::string> partial_in(const RunRecord& record) {
  std::vector<std::string> names = estimators_in({&record, 1});
  std::erase_if(names, [&](const std::string& name) { return !is_partial(record, name); });
  return names;
}

const RunRecord* example_run(std::span<const RunRecord> runs, const std::string& estimator) {
  const auto found = std::ranges::find_if(runs, [&](const RunRecord& run) {
    if (!is_valid_run(run)) return false;
    return estimator.empty() ? !value_in(run.scores, "estimators", Json::object()).empty()
                             : !estimator_in(run, estimator).is_null();
  });
  return found == runs.end() ? nullptr : &*found;
}

std::vector<std::string> score_keys_in(std::span<const RunRecord> runs,
                                       const std::string& estimator) {
  const RunRecord* example = example_run(runs, estimator);
  return example == nullptr ? std::vector<std::string>() : score_keys(*example, estimator);
}

std::string part_mark(bool partial) { return partial ? " part" : ""; }

std::optional<double> worst_of(const std::vector<double>& values, const std::string& key) {
  if (values.empty()) return std::nullopt;
  if (better_of(key) == Better::kNeither) {  // of errors with a sign, the largest
    return *std::ranges::max_element(values, {}, [](double value) { return std::abs(value); });
  }
  const auto [smallest, largest] = std::ranges::minmax(values);
  return better_of(key) == Better::kLarger ? smallest : largest;
}

double smallest_change(const std::string& key, double before) {
  double floor = 0.0;
  for (const Score& each : headline_scores()) {
    if (each.key == key) floor = each.floor;
  }
  return std::max(floor, kMinChange * std::abs(before));
}

ScoreStatistics statistics_of(std::span<const RunRecord> runs, const std::string& estimator,
                              const std::string& key) {
  const std::vector<double> values = values_of(runs, estimator, key);
  return {median(values), worst_of(values, key), values.size()};
}

Interval median_interval(std::span<const RunRecord> runs, const std::string& estimator,
                         const std::string& key) {
  const std::vector<double> values = values_of(runs, estimator, key);
  std::vector<double> sample(values.size());
  return bootstrap_interval(
      values.size(),
      [&](std::span<const std::size_t> drawn) {
        std::transform(drawn.begin(), drawn.end(), sample.begin(),
                       [&](std::size_t index) { return values[index]; });
        return median(sample);
      },
      kBootstrapSeed);
}

std::size_t finished(std::span<const RunRecord> runs, const std::string& estimator) {
  return static_cast<std::size_t>(
      std::count_if(runs.begin(), runs.end(), [&](const RunRecord& run) {
        return is_valid_run(run) && !estimator_in(run, estimator).is_null();
      }));
}

std::size_t successes(std::span<const RunRecord> runs, const std::string& estimator,
                      const std::string& key) {
  return static_cast<std::size_t>(std::count_if(
      runs.begin(), runs.end(),
      [&](const RunRecord& run) { return succeeds(run, estimator, key).value_or(false); }));
}

std::string SuccessRate::text() const {
  if (runs == 0) return "-";
  const Interval bounds = interval();
  return fmt::format("{}/{} ({:.0f}-{:.0f} %)", count, runs, 100.0 * *bounds.low,
                     100.0 * *bounds.high);
}

SuccessRate success_rate(std::span<const RunRecord> runs, const std::string& estimator,
                         const std::string& key) {
  SuccessRate rate;
  for (const RunRecord& run : runs) {
    const auto success = succeeds(run, estimator, key);
    rate.runs += success.has_value();
    rate.count += success.value_or(false);
  }
  return rate;
}

std::optional<bool> succeeds(const RunRecord& run, const std::string& estimator,
                             const std::string& key) {
  if (!is_valid_run(run)) return std::nullopt;
  if (failed_in(run, estimator)) return false;
  const auto value = find_score(run, estimator, key);
  return value ? std::optional(*value == 1.0) : std::nullopt;
}

void SuccessDifferences::add(std::uint64_t seed, bool first, bool second) {
  ++counts_.sequences;
  counts_.only_first += first && !second;
  counts_.only_second += !first && second;
  surplus_[seed] += static_cast<int>(first) - static_cast<int>(second);
}

SuccessTest SuccessDifferences::test() const {
  SuccessTest test = counts_;
  test.seeds = surplus_.size();
  const auto count = [&](auto&& is_counted) {
    return static_cast<std::size_t>(std::ranges::count_if(
        surplus_, [&](const auto& of_seed) { return is_counted(of_seed.second); }));
  };
  test.by_seed = mcnemar_test(count([](int surplus) { return surplus > 0; }),
                              count([](int surplus) { return surplus < 0; }));
  return test;
}

McNemarTest success_test(const EstimatorRuns& first, const EstimatorRuns& second,
                         const std::string& key) {
  SuccessDifferences differences;
  for (const RunRecord& a : first.runs) {
    for (const RunRecord& b : second.runs) {
      if (a.seed != b.seed) continue;
      const auto one = succeeds(a, first.estimator, key);
      const auto other = succeeds(b, second.estimator, key);
      if (one && other) differences.add(a.seed, *one, *other);
    }
  }
  return differences.test().by_seed;
}

std::vector<double> ScorePairs::differences() const {
  std::vector<double> differences(value.size());
  std::transform(value.begin(), value.end(), reference.begin(), differences.begin(),
                 std::minus<>());
  return differences;
}

std::optional<double> compared_score(const RunRecord& run, const std::string& estimator,
                                     const std::string& key) {
  if (!is_partial(run, estimator)) return find_score(run, estimator, key);
  const bool is_success =
      std::ranges::any_of(success_scores(), [&](const Score& each) { return each.key == key; });
  return is_success ? std::optional(0.0) : std::nullopt;
}

ScorePairs paired(const EstimatorRuns& reference, const EstimatorRuns& other,
                  const std::string& key) {
  ScorePairs pairs;
  for (const RunRecord& a : reference.runs) {
    for (const RunRecord& b : other.runs) {
      if (a.seed != b.seed || !is_valid_run(a) || !is_valid_run(b)) continue;
      const auto first = compared_score(a, reference.estimator, key);
      const auto second = compared_score(b, other.estimator, key);
      if (!first || !second) continue;
      pairs.reference.push_back(*first);
      pairs.value.push_back(*second);
    }
  }
  return pairs;
}

PairedStatistics statistics_of(const ScorePairs& pairs) {
  PairedStatistics statistics;
  statistics.count = pairs.value.size();
  if (statistics.count == 0) return statistics;
  statistics.reference_median = median(pairs.reference);
  statistics.median = median(pairs.value);
  statistics.worst = *std::ranges::max_element(pairs.value);
  if (*statistics.reference_median > 0.0) {
    statistics.ratio = *statistics.median / *statistics.reference_median;
  }
  const std::vector<double> differences = pairs.differences();
  statistics.change = *mean(differences);
  statistics.interval = mean_interval(differences);
  return statistics;
}

Interval mean_interval(const std::vector<double>& values) {
  return bootstrap_interval(
      values.size(),
      [&](std::span<const std::size_t> drawn) {
        double sum = 0.0;
        for (const std::size_t index : drawn) sum += values[index];
        return std::optional<double>(sum / static_cast<double>(drawn.size()));
      },
      kBootstrapSeed, kMeanReplicates);
}

}  // namespace aims
