// SPDX-License-Identifier: BSD-3-Clause
#include "bench/metrics/paired_test.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>
#include <vector>

#include "core/random.hpp"

namespace aims {
namespace {

/// Differences about `change`: symmetric, with heavy tails (Laplace).
std::vector<double> differences_about(double change, std::size_t count, RandomStream& random) {
  std::vector<double> differences(count);
  for (double& each : differences) {
    const double size = -std::log(1.0 - random.uniform());
    each = change + (random.chance(0.5) ? size : -size);
  }
  return differences;
}

/// Four standard deviations of the fraction of successes in `trials`.
double four_sigma(double probability, int trials) {
  return 4.0 * std::sqrt(probability * (1.0 - probability) / trials);
}

TEST(PairedTest, OfSixPairsIsKnownInClosedForm) {
  const PairedTest test = paired_test(std::vector<double>{0.3, 0.1, 0.6, 0.2, 0.5, 0.4});
  EXPECT_NEAR(test.change, 0.35, 1e-12);
  EXPECT_DOUBLE_EQ(test.p, 2.0 / 64.0) << "only all signs as they are, or all turned";
  EXPECT_DOUBLE_EQ(*test.interval.low, 0.1) << "the smallest mean of a subset";
  EXPECT_DOUBLE_EQ(*test.interval.high, 0.6);
  EXPECT_TRUE(test.found());
}

TEST(PairedTest, OfFewPairsGivesTheSmallestPThatThereIsAndNoInterval) {
  const PairedTest test = paired_test(std::vector<double>{0.010, 0.0136, 0.0021});
  EXPECT_DOUBLE_EQ(test.p, 0.25);
  EXPECT_EQ(test.interval, Interval{});
  EXPECT_FALSE(test.detectable);
  EXPECT_FALSE(test.found());
  EXPECT_DOUBLE_EQ(smallest_p(3), 0.25);
  EXPECT_GT(smallest_p(kFewestPairs - 1), 0.05);
  EXPECT_LE(smallest_p(kFewestPairs), 0.05);
  EXPECT_EQ(smallest_p(0), 1.0);
}

TEST(PairedTest, CountsTheSignsThatGiveAsMuch) {
  // Of 3, 2 and -1 in any signs, sums of 4 or more: 6, 4; of -4 or less as many.
  EXPECT_DOUBLE_EQ(paired_test(std::vector<double>{3.0, 2.0, -1.0}).p, 4.0 / 8.0);
  EXPECT_DOUBLE_EQ(paired_test(std::vector<double>{0.3, -0.1, -0.2}).p, 1.0) << "a sum of zero";
  EXPECT_EQ(paired_test(std::vector<double>(8, 0.0)).p, 1.0);
  EXPECT_EQ(paired_test({}).p, 1.0);
}

TEST(PairedTest, IntervalAndPAreOneRule) {
  RandomStream random = rng(3, "paired_test_test");
  int found = 0;
  for (int trial = 0; trial < 600; ++trial) {
    const std::size_t count = 6 + static_cast<std::size_t>(trial) % 10;
    const PairedTest test = paired_test(differences_about(0.7, count, random));
    EXPECT_EQ(test.found(), test.p <= 0.05) << count << " pairs, p " << test.p;
    found += test.found();
  }
  EXPECT_GT(found, 100);
  EXPECT_LT(found, 500);
}

TEST(PairedTest, IntervalCoversTheTrueChangeAsOftenAsItSays) {
  RandomStream random = rng(4, "paired_test_test");
  // 1 - 2 k / 2^n with k = floor(0.025 2^n); above 13 pairs the signs are drawn.
  const std::vector<std::pair<std::size_t, double>> cases = {
      {6, 1.0 - 2.0 / 64.0}, {7, 1.0 - 6.0 / 128.0}, {10, 1.0 - 50.0 / 1024.0}, {16, 0.95}};
  for (const auto& [count, expected] : cases) {
    const int trials = count > 13 ? 800 : 3000;
    int covered = 0;
    for (int trial = 0; trial < trials; ++trial) {
      const Interval interval = paired_test(differences_about(2.0, count, random)).interval;
      covered += *interval.low < 2.0 && 2.0 < *interval.high;
    }
    EXPECT_NEAR(static_cast<double>(covered) / trials, expected, four_sigma(expected, trials))
        << count << " pairs";
  }
}

TEST(PairedTest, FindsAChangeWhereThereIsNoneInFivePercentAtMost) {
  RandomStream random = rng(5, "paired_test_test");
  for (const std::size_t count : {2U, 3U, 5U, 6U, 8U, 11U}) {
    int found = 0;
    constexpr int kTrials = 2000;
    for (int trial = 0; trial < kTrials; ++trial) {
      found += paired_test(differences_about(0.0, count, random)).p <= 0.05;
    }
    EXPECT_LE(static_cast<double>(found) / kTrials, 0.05 + four_sigma(0.05, kTrials)) << count;
    EXPECT_TRUE(found == 0 || count >= kFewestPairs) << count;
  }
}

TEST(PairedTest, DetectsAChangeAboveTheDetectableOneAndNoneBelow) {
  RandomStream random = rng(6, "paired_test_test");
  for (int trial = 0; trial < 100; ++trial) {
    std::vector<double> differences = differences_about(0.0, 9, random);
    const PairedTest test = paired_test(differences);
    for (const double factor : {0.5, 1.001}) {
      bool both = true;
      for (const double sign : {1.0, -1.0}) {
        std::vector<double> moved = differences;
        const double shift = sign * factor * *test.detectable - test.change;
        for (double& each : moved) each += shift;
        both = both && paired_test(moved).found();
      }
      EXPECT_EQ(both, factor > 1.0);
    }
  }
}

TEST(PairedTest, FalseAlarmsAreCountedOverAllSigns) {
  const std::vector<double> differences = {0.3, 0.1, 0.6, 0.2, 0.5, 0.4};
  EXPECT_DOUBLE_EQ(false_alarm_rate(differences, 0.0), 2.0 / 64.0);
  EXPECT_EQ(false_alarm_rate(differences, 0.36), 0.0) << "no mean is above 0.35";
  EXPECT_EQ(false_alarm_rate(std::vector<double>{0.3, 0.1, 0.6}, 0.0), 0.0);
  EXPECT_EQ(false_alarm_rate(std::vector<double>(7, 0.0), 0.0), 0.0);
}

}  // namespace
}  // namespace aims
