// SPDX-License-Identifier: BSD-3-Clause

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "bench/metrics/statistics.hpp"
#include "core/random.hpp"

namespace aims {
namespace {

ClusterStatistic mean_of(const std::vector<double>& values) {
  return [&values](std::span<const std::size_t> drawn) {
    std::vector<double> sample;
    for (const std::size_t index : drawn) sample.push_back(values[index]);
    return mean(sample);
  };
}

std::vector<double> normal_values(std::uint64_t seed, std::size_t count) {
  RandomStream random = rng(seed, "test.bootstrap");
  std::vector<double> values(count);
  for (double& value : values) value = 3.0 + 2.0 * random.normal();
  return values;
}

TEST(Bootstrap, CoversTheKnownMeanAtTheStatedRate) {
  constexpr int kTrials = 400;
  int covered = 0;
  for (int trial = 0; trial < kTrials; ++trial) {
    const auto values = normal_values(static_cast<std::uint64_t>(trial), 30);
    const Interval interval = bootstrap_interval(30, mean_of(values), 1, 400, 0.9);
    covered += *interval.low <= 3.0 && 3.0 <= *interval.high;
  }
  // 90 % less the known narrowness of about 2 % at 30 values; +- 3 deviations of the count.
  EXPECT_NEAR(covered / static_cast<double>(kTrials), 0.88, 0.05);
}

TEST(Bootstrap, IsAsWideAsTheErrorOfTheMean) {
  const auto values = normal_values(5, 200);
  const Interval interval = bootstrap_interval(200, mean_of(values), 1, 4000);
  EXPECT_NEAR(*interval.high - *interval.low, 2.0 * 1.96 * 2.0 / std::sqrt(200.0), 0.06);
}

TEST(Bootstrap, GivesTheSameForTheSameSeedOnly) {
  const auto values = normal_values(5, 10);
  EXPECT_EQ(bootstrap_interval(10, mean_of(values), 1), bootstrap_interval(10, mean_of(values), 1));
  EXPECT_FALSE(bootstrap_interval(10, mean_of(values), 1) ==
               bootstrap_interval(10, mean_of(values), 2));
}

TEST(Bootstrap, DrawsEveryClusterAndNoOther) {
  std::vector<int> counts(3, 0);
  bootstrap_interval(
      3,
      [&](std::span<const std::size_t> drawn) {
        EXPECT_EQ(drawn.size(), 3U);
        for (const std::size_t index : drawn) ++counts.at(index);
        return std::optional<double>(0.0);
      },
      1);
  for (const int count : counts) EXPECT_NEAR(count, 1000, 120);
}

TEST(Bootstrap, OfOneClusterOrOfNoValueIsEmpty) {
  const std::vector<double> one = {1.0};
  EXPECT_EQ(bootstrap_interval(1, mean_of(one), 1), Interval{});
  EXPECT_EQ(bootstrap_interval(0, mean_of(one), 1), Interval{});
  const auto nothing = [](std::span<const std::size_t>) { return std::optional<double>(); };
  EXPECT_EQ(bootstrap_interval(9, nothing, 1), Interval{});
}

TEST(Bootstrap, LeavesOutReplicatesWithoutAValue) {
  const auto first_only = [](std::span<const std::size_t> drawn) {
    return drawn[0] == 0 ? std::optional<double>(7.0) : std::nullopt;
  };
  const Interval interval = bootstrap_interval(2, first_only, 1);
  EXPECT_EQ(interval, (Interval{7.0, 7.0}));
}

}  // namespace
}  // namespace aims
