// SPDX-License-Identifier: BSD-3-Clause
#include "lab/fidelity/imu_statistics.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace aims {
namespace {

/// Ten seconds in which axis z of the accelerometer swings with 3 m/s^2 at 4 Hz.
std::vector<ImuSample> swinging() {
  std::vector<ImuSample> samples;
  for (int i = 0; i < 4000; ++i) {
    ImuSample sample;
    const double time = i / kImuStatisticsRate;
    sample.specific_force.z() = 9.81 + 3.0 * std::sin(2.0 * std::numbers::pi * 4.0 * time);
    samples.push_back(sample);
  }
  return samples;
}

const ImuStatistic& find(const std::vector<ImuStatistic>& all, const std::string& quantity,
                         char axis) {
  return *std::ranges::find_if(all, [&](const ImuStatistic& each) {
    return each.quantity == quantity && each.axis == axis;
  });
}

TEST(ImuStatistics, AreThoseOfASine) {
  const auto statistics = trot_statistics(swinging());
  ASSERT_TRUE(statistics);
  EXPECT_NEAR(find(*statistics, "acc. std", 'z').simulated, 3.0 / std::sqrt(2.0), 0.01);
  EXPECT_NEAR(find(*statistics, "acc. largest deviation", 'z').simulated, 3.0, 0.01);
  EXPECT_NEAR(find(*statistics, "acc. rms 0.5-5 Hz", 'z').simulated, 3.0 / std::sqrt(2.0), 0.05);
  EXPECT_LT(find(*statistics, "acc. rms 12.5-25 Hz", 'z').simulated, 0.05);
  EXPECT_EQ(find(*statistics, "gyro std", 'x').simulated, 0.0);
}

TEST(ImuStatistics, AFactorIsTheSameAboveAndBelowTheRealFigure) {
  EXPECT_DOUBLE_EQ((ImuStatistic{"q", "u", 'x', 3.0, 2.0, 2.0}).factor(), 1.5);
  EXPECT_DOUBLE_EQ((ImuStatistic{"q", "u", 'x', 1.0, 2.0, 2.0}).factor(), 2.0);
  EXPECT_DOUBLE_EQ((ImuStatistic{"q", "u", 'x', 0.1, 0.08, 0.17}).factor(), 1.0);
}

TEST(ImuStatistics, NeedEnoughSamples) {
  const std::vector<ImuSample> few(700);
  EXPECT_FALSE(trot_statistics(few));
  EXPECT_FALSE(standing_statistics(few));
}

}  // namespace
}  // namespace aims
