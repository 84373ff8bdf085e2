// SPDX-License-Identifier: BSD-3-Clause
#include "lab/fidelity/allan_deviation.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "core/random.hpp"

namespace aims {
namespace {

constexpr double kRate = 50.0;  ///< [Hz]
const std::vector<double> kTimes = {0.02, 0.1, 1.0, 4.0};

TEST(AllanDeviation, WhiteNoiseFallsWithTheRootOfTheAveragingTime) {
  RecordProperty("seed", 5);
  RandomStream random(5, "test.white");
  const double density = 0.003;
  std::vector<double> series;
  for (int i = 0; i < 60'000; ++i) series.push_back(density * std::sqrt(kRate) * random.normal());
  const auto points = allan_deviation(series, kRate, kTimes);
  ASSERT_EQ(points.size(), kTimes.size());
  for (const AllanPoint& point : points) {
    const double expected = density / std::sqrt(point.tau);
    EXPECT_NEAR(point.deviation, expected, 0.1 * expected) << point.tau;
  }
}

TEST(AllanDeviation, ARandomWalkRisesWithTheRootOfTheAveragingTime) {
  RecordProperty("seed", 6);
  RandomStream random(6, "test.walk");
  const double walk = 0.02;
  double value = 3.0;
  std::vector<double> series;
  for (int i = 0; i < 60'000; ++i) {
    value += walk / std::sqrt(kRate) * random.normal();
    series.push_back(value);
  }
  // The steps of the walk show below 1 s.
  for (const AllanPoint& point : allan_deviation(series, kRate, std::vector<double>{1.0, 4.0})) {
    const double expected = walk * std::sqrt(point.tau / 3.0);
    EXPECT_NEAR(point.deviation, expected, 0.15 * expected) << point.tau;
  }
}

TEST(AllanDeviation, ARampGrowsWithTheAveragingTime) {
  std::vector<double> series;
  for (int i = 0; i < 1000; ++i) series.push_back(0.3 * i / kRate);
  const auto points = allan_deviation(series, kRate, kTimes);
  ASSERT_FALSE(points.empty());
  for (const AllanPoint& point : points) {
    EXPECT_NEAR(point.deviation, 0.3 * point.tau / std::numbers::sqrt2, 1e-9);
  }
}

TEST(AllanDeviation, AConstantHasNone) {
  const std::vector<double> series(1000, 9.81);
  const auto points = allan_deviation(series, kRate, kTimes);
  ASSERT_FALSE(points.empty());
  for (const AllanPoint& point : points) {
    EXPECT_NEAR(point.deviation, 0.0, 1e-9);
  }
}

TEST(AllanDeviation, LeavesOutTimesThatTheSeriesDoesNotHoldTwice) {
  const std::vector<double> series(100, 1.0);
  const std::vector<double> times = {0.5, 1.0, 1.1, 50.0};
  const auto points = allan_deviation(series, kRate, times);
  ASSERT_EQ(points.size(), 2U);
  EXPECT_EQ(points[1].tau, 1.0);
  EXPECT_TRUE(allan_deviation({}, kRate, times).empty());
}

}  // namespace
}  // namespace aims
