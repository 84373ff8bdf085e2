// SPDX-License-Identifier: BSD-3-Clause
#include "bench/metrics/statistics.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <vector>

namespace aims {
namespace {

TEST(Statistics, QuantileInterpolatesBetweenOrderStatistics) {
  const std::vector<double> values = {4.0, 1.0, 3.0, 2.0};
  EXPECT_EQ(quantile(values, 0.0), 1.0);
  EXPECT_EQ(quantile(values, 1.0), 4.0);
  EXPECT_EQ(quantile(values, 0.5), 2.5);
  EXPECT_NEAR(*quantile(values, 0.99), 3.97, 1e-12);
  EXPECT_NEAR(*quantile(values, 0.25), 1.75, 1e-12);
}

TEST(Statistics, MedianOfAnOddCountIsTheMiddle) {
  EXPECT_EQ(median(std::vector<double>{9.0, 1.0, 5.0}), 5.0);
  EXPECT_EQ(median(std::vector<double>{7.0}), 7.0);
}

TEST(Statistics, OfNothingHaveNoValue) {
  EXPECT_FALSE(mean({}));
  EXPECT_FALSE(median({}));
  EXPECT_FALSE(quantile({}, 0.3));
  EXPECT_FALSE(summarize({}));
  EXPECT_FALSE(summarize(std::vector<double>{std::numeric_limits<double>::quiet_NaN()}));
}

TEST(Statistics, SummaryCountsWhatIsMissing) {
  const double inf = std::numeric_limits<double>::infinity();
  const auto summary = summarize(std::vector<double>{3.0, inf, 1.0, 2.0});
  ASSERT_TRUE(summary);
  EXPECT_EQ(summary->count, 3);
  EXPECT_EQ(summary->missing, 1);
  EXPECT_EQ(summary->mean, 2.0);
  EXPECT_EQ(summary->p50, 2.0);
  EXPECT_NEAR(summary->p99, 2.98, 1e-12);
  EXPECT_EQ(summary->worst, 3.0);
}

}  // namespace
}  // namespace aims
