// SPDX-License-Identifier: BSD-3-Clause
#include "bench/metrics/statistics.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

namespace aims {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

double tau(const std::vector<double>& x, const std::vector<double>& y) {
  return kendall_tau(x, y).value();
}

TEST(RankCorrelation, CountsTheSwapsThatSortingTakes) {
  // Without ties tau is 1 - 4 I / (n (n - 1)) with the inversions I, which bubble sort counts.
  std::vector<double> y = {0, 1, 2, 3, 4, 5};
  const std::vector<double> x = y;
  do {
    std::vector<double> sorted = y;
    int swaps = 0;
    for (std::size_t pass = 0; pass < sorted.size(); ++pass) {
      for (std::size_t i = 1; i < sorted.size(); ++i) {
        if (sorted[i - 1] <= sorted[i]) continue;
        std::swap(sorted[i - 1], sorted[i]);
        ++swaps;
      }
    }
    ASSERT_NEAR(tau(x, y), 1.0 - 4.0 * swaps / 30.0, 1e-12);
  } while (std::next_permutation(y.begin(), y.end()));
}

TEST(RankCorrelation, CorrectsForTies) {
  // Pairs: 4 concordant, 1 discordant, 1 tied in x alone: 3 / sqrt(5 * 6).
  EXPECT_NEAR(tau({1, 1, 2, 3}, {1, 2, 4, 3}), 3.0 / std::sqrt(30.0), 1e-12);
}

TEST(RankCorrelation, PutsInfiniteValuesLastAndTiesThem) {
  EXPECT_NEAR(tau({1, 2, kInfinity}, {10, 20, 30}), 1.0, 1e-12);
  EXPECT_NEAR(tau({1, kInfinity, kInfinity}, {1, 2, 3}), 2.0 / std::sqrt(6.0), 1e-12);
}

TEST(RankCorrelation, HasNoValueWithoutAnOrder) {
  EXPECT_FALSE(kendall_tau(std::array{1.0, 1.0}, std::array{1.0, 2.0}));
  EXPECT_FALSE(kendall_tau(std::array{1.0}, std::array{1.0}));
  EXPECT_FALSE(kendall_tau(std::array{1.0, std::nan("")}, std::array{1.0, 2.0}));
}

}  // namespace
}  // namespace aims
