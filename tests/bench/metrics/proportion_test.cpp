// SPDX-License-Identifier: BSD-3-Clause
#include "bench/metrics/statistics.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace aims {
namespace {

// Newcombe 1998, Two-sided confidence intervals for the single proportion, table I, method 3.
TEST(WilsonInterval, AgreesWithPublishedOnes) {
  struct Published {
    std::size_t count, trials;
    double low, high;
  };
  for (const auto& [count, trials, low, high] : {Published{81, 263, 0.2553, 0.3662},
                                                 {15, 148, 0.0624, 0.1605},
                                                 {0, 20, 0.0000, 0.1611},
                                                 {1, 29, 0.0061, 0.1718}}) {
    const Interval interval = wilson_interval(count, trials);
    EXPECT_NEAR(interval.low.value(), low, 5e-5) << count << "/" << trials;
    EXPECT_NEAR(interval.high.value(), high, 5e-5) << count << "/" << trials;
  }
}

TEST(WilsonInterval, EndsWhereTheCountIsAtTheQuantileOfANormal) {
  // The definition: |x - n p| = z sqrt(n p (1 - p)) at both ends.
  for (const auto& [count, trials] : {std::pair{3, 7}, {18, 20}, {193, 200}}) {
    const Interval interval = wilson_interval(count, trials);
    for (const double p : {*interval.low, *interval.high}) {
      EXPECT_NEAR(std::abs(count - trials * p) / std::sqrt(trials * p * (1.0 - p)), 1.959964, 1e-5);
    }
  }
}

TEST(WilsonInterval, OfNoTrialsIsEmpty) { EXPECT_EQ(wilson_interval(0, 0), Interval{}); }

// Fagerland, Lydersen and Laake 2013, BMC Medical Research Methodology 13:91: 1 and 7, and 6 and 16
// discordant pairs: 0.0703 and 0.0525.
TEST(McNemarTest, AgreesWithPublishedOnes) {
  EXPECT_NEAR(mcnemar_test(1, 7).p, 0.0703, 5e-5);
  EXPECT_NEAR(mcnemar_test(16, 6).p, 0.0525, 5e-5);
}

TEST(McNemarTest, AgreesWithCoinsCountedByHand) {
  EXPECT_DOUBLE_EQ(mcnemar_test(0, 0).p, 1.0);
  EXPECT_DOUBLE_EQ(mcnemar_test(3, 3).p, 1.0);
  EXPECT_NEAR(mcnemar_test(5, 0).p, 2.0 / 32.0, 1e-12);
  EXPECT_NEAR(mcnemar_test(0, 6).p, 2.0 / 64.0, 1e-12);
  EXPECT_NEAR(mcnemar_test(1, 4).p, 2.0 * (1.0 + 5.0) / 32.0, 1e-12);
  EXPECT_GT(mcnemar_test(40, 400).p, 0.0);
  EXPECT_LT(mcnemar_test(40, 400).p, 1e-30);
}

TEST(McNemarTest, FindsWhatIsNotThereAsOftenAsAnnounced) {
  for (std::size_t n = 0; n <= 30; ++n) {
    double probability = 0.0;
    double binomial = std::exp2(-static_cast<double>(n));  // n over k, times 2^-n
    for (std::size_t k = 0; k <= n; ++k) {
      if (mcnemar_test(k, n - k).p <= 0.05) probability += binomial;
      binomial *= static_cast<double>(n - k) / static_cast<double>(k + 1);
    }
    EXPECT_NEAR(mcnemar_false_alarm(n), probability, 1e-9) << n;
    EXPECT_LE(mcnemar_false_alarm(n), 0.05);
  }
  EXPECT_EQ(mcnemar_false_alarm(5), 0.0);
}

}  // namespace
}  // namespace aims
