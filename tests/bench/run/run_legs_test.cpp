// SPDX-License-Identifier: BSD-3-Clause
#include "bench/run/run_legs.hpp"

#include <gtest/gtest.h>

namespace aims {
namespace {

constexpr Duration kSpacing = 5 * kMillisecond;  ///< of packets at 200 Hz

Delivery packet(Time stamp) {
  LegOdometrySample sample;
  sample.stamp = stamp;
  return {stamp, sample};
}

/// The packets of `span`, but for every `lost`-th; 0: all of them.
LegPackets packets(Duration span, int lost, Duration offset = 0) {
  LegPackets came;
  for (int i = 1; i * kSpacing <= span; ++i) {
    if (lost > 0 && i % lost == 0) continue;
    const std::vector<Delivery> twice(2, packet(i * kSpacing + offset));
    came.count(twice);
  }
  return came;
}

TEST(LegIntervales, CountLostPacketsOnceWhateverComesTwice) {
  const SimulationConfig config;
  for (const auto& each : leg_intervals(config, packets(kSecond, 0), {}, kSecond)) {
    EXPECT_EQ(each.loss, 0.0);
  }
  const auto halved = leg_intervals(config, packets(kSecond, 2), {}, kSecond);
  ASSERT_EQ(halved.size(), 10U);
  for (const auto& each : halved) EXPECT_DOUBLE_EQ(each.loss, 0.5);
  EXPECT_EQ(halved.front().stamp, kLegInterval);
  EXPECT_EQ(leg_intervals(config, {}, {}, kSecond).front().loss, 1.0);
}

TEST(LegIntervales, TakeStampsOfAWrongClockForWhatTheyMean) {
  SimulationConfig config;
  config.links.leg_odometry.clock_offset = 0.02;
  const auto came = packets(kSecond, 0, 20 * kMillisecond);
  for (const auto& each : leg_intervals(config, came, {}, kSecond)) EXPECT_EQ(each.loss, 0.0);
}

TEST(LegIntervales, SlipIsTheMeanOfTheFastestFoot) {
  Truth truth;
  for (int i = 1; i <= 100; ++i) {
    TruthSample sample;
    sample.stamp = i * 2 * kMillisecond;
    sample.slip_speed = {0.1, i <= 25 ? 0.5 : 0.3, 0.0, 0.2};
    truth.samples.push_back(sample);
  }
  const auto stretches = leg_intervals({}, {}, truth, 250 * kMillisecond);
  ASSERT_EQ(stretches.size(), 2U);
  EXPECT_NEAR(stretches[0].slip, 0.4, 1e-12);
  EXPECT_NEAR(stretches[1].slip, 0.3, 1e-12);
}

}  // namespace
}  // namespace aims
