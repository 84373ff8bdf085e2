// SPDX-License-Identifier: BSD-3-Clause
#include "bench/metrics/paired_test.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <vector>

#include "bench/metrics/statistics.hpp"
#include "core/random.hpp"

namespace aims {
namespace {

constexpr double kLevel = 0.05;
constexpr std::size_t kMostEnumerated = 13;
constexpr std::size_t kDrawn = (std::size_t{1} << kMostEnumerated) - 1;

/// The sum of a subset of differences and how many they are.
struct Subset {
  double sum = 0.0;
  std::size_t count = 0;
};

/// Every subset but the empty one, or as many as are drawn. Sums that differ from zero by rounding
/// only are zero.
std::vector<Subset> subsets_of(std::span<const double> differences) {
  const std::size_t n = differences.size();
  const bool all = n <= kMostEnumerated;
  double size = 0.0;
  for (const double each : differences) size += std::abs(each);
  RandomStream random = rng(1, "paired_test");
  std::vector<Subset> subsets;
  const std::size_t wanted = all ? (std::size_t{1} << n) - 1 : kDrawn;
  while (subsets.size() < wanted) {
    const std::size_t members = subsets.size() + 1;
    Subset subset;
    for (std::size_t i = 0; i < n; ++i) {
      if (all ? (members >> i & 1U) == 0 : !random.chance(0.5)) continue;
      subset.sum += differences[i];
      ++subset.count;
    }
    if (subset.count == 0) continue;
    if (std::abs(subset.sum) <= 1e-12 * size) subset.sum = 0.0;
    subsets.push_back(subset);
  }
  return subsets;
}

std::vector<double> sorted_means(const std::vector<Subset>& subsets) {
  std::vector<double> means;
  for (const Subset& each : subsets) means.push_back(each.sum / static_cast<double>(each.count));
  std::sort(means.begin(), means.end());
  return means;
}

/// How many of `choices` equally likely ones are in a tail of probability `level`.
std::size_t tail(std::size_t choices, double level) {
  return static_cast<std::size_t>(level * static_cast<double>(choices));
}

}  // namespace

PairedTest paired_test(std::span<const double> differences) {
  PairedTest test;
  if (differences.empty()) return test;
  test.change = *mean(differences);
  // Turning the signs of a subset lowers the sum by twice the subset's: the turned sum is as large
  // as the sum itself, or larger, when the subset's is not positive. The empty one counts as both.
  const std::vector<double> means = sorted_means(subsets_of(differences));
  const std::size_t choices = means.size() + 1;
  const auto not_positive = std::upper_bound(means.begin(), means.end(), 0.0) - means.begin();
  const auto not_negative = means.end() - std::lower_bound(means.begin(), means.end(), 0.0);
  const auto rarer = static_cast<double>(1 + std::min(not_positive, not_negative));
  test.p = std::min(1.0, 2.0 * rarer / static_cast<double>(choices));
  if (differences.size() < kFewestPairs) return test;
  const std::size_t outside = tail(choices, 0.5 * kLevel);
  test.interval = {means[outside - 1], means[means.size() - outside]};
  test.detectable = std::max(test.change - *test.interval.low, *test.interval.high - test.change);
  return test;
}

double smallest_p(std::size_t pairs) {
  return std::min(1.0, std::exp2(1.0 - static_cast<double>(pairs)));
}

double false_alarm_rate(std::span<const double> differences, double floor) {
  if (differences.size() < kFewestPairs) return 0.0;
  const auto count = static_cast<double>(differences.size());
  const double change = *mean(differences);
  std::vector<double> sizes = {std::abs(change)};
  for (const Subset& each : subsets_of(differences)) {
    sizes.push_back(std::abs(change - 2.0 * each.sum / count));
  }
  std::sort(sizes.begin(), sizes.end(), std::greater<>());
  // Those of p <= 0.05: as many as fit into both tails, without those equal to the next one.
  const std::size_t fit = 2 * tail(sizes.size(), 0.5 * kLevel);
  const double critical = sizes[fit] * (1.0 + 1e-9);
  const auto alarms = std::count_if(sizes.begin(), sizes.end(),
                                    [&](double size) { return size > critical && size > floor; });
  return static_cast<double>(alarms) / static_cast<double>(sizes.size());
}

}  // namespace aims
