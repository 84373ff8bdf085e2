// SPDX-License-Identifier: BSD-3-Clause
#include "bench/scoring/score_statistics.hpp"

#include <fmt/format.h>

#include <algorithm>
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

std::optional<double> largest(const std::vector<double>& values) {
  if (values.empty()) return std::nullopt;
  return *std::max_element(values.begin(), values.end());
}

std::optional<double> smallest(const std::vector<double>& values) {
  if (values.empty()) return std::nullopt;
  return *std::min_element(values.begin(), values.end());
}

}  // namespace

ScoreStatistics statistics_of(std::span<const RunRecord> runs, const std::string& estimator,
                              const std::string& key) {
  const std::vector<double> values = values_of(runs, estimator, key);
  const bool more_is_better = better_of(key) == Better::kLarger;
  return {median(values), more_is_better ? smallest(values) : largest(values), values.size()};
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
  const auto value = find_score(run, estimator, key);
  return value ? std::optional(*value == 1.0) : std::nullopt;
}

McNemarTest success_test(const EstimatorRuns& first, const EstimatorRuns& second,
                         const std::string& key) {
  std::size_t only_first = 0;
  std::size_t only_second = 0;
  for (const RunRecord& a : first.runs) {
    for (const RunRecord& b : second.runs) {
      if (a.seed != b.seed) continue;
      const auto one = succeeds(a, first.estimator, key);
      const auto other = succeeds(b, second.estimator, key);
      if (!one || !other) continue;
      only_first += *one && !*other;
      only_second += !*one && *other;
    }
  }
  return mcnemar_test(only_first, only_second);
}

std::vector<double> ScorePairs::differences() const {
  std::vector<double> differences(value.size());
  std::transform(value.begin(), value.end(), reference.begin(), differences.begin(),
                 std::minus<>());
  return differences;
}

ScorePairs paired(const EstimatorRuns& reference, const EstimatorRuns& other,
                  const std::string& key) {
  ScorePairs pairs;
  for (const RunRecord& a : reference.runs) {
    for (const RunRecord& b : other.runs) {
      if (a.seed != b.seed || !is_valid_run(a) || !is_valid_run(b)) continue;
      const auto first = find_score(a, reference.estimator, key);
      const auto second = find_score(b, other.estimator, key);
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
  statistics.worst = largest(pairs.value);
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
