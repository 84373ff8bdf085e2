// SPDX-License-Identifier: BSD-3-Clause
#include "estimator/filter/stamp_jumps.hpp"

#include <gtest/gtest.h>

#include <limits>

namespace aims {
namespace {

Delivery imu(Time stamp, Time arrival) { return {arrival, ImuSample{.stamp = stamp}}; }

/// Stamps that come through, of samples at 50 Hz that arrive 5 ms late; sample `hit` is changed.
std::vector<Time> through(StampJumps& jumps, int hit, Duration shift, bool all_after = false) {
  std::vector<Delivery> good;
  for (int i = 0; i < 20; ++i) {
    const Time stamp = i * 20 * kMillisecond;
    const bool shifted = i == hit || (all_after && i > hit);
    jumps.take(imu(stamp + (shifted ? shift : 0), stamp + 5 * kMillisecond), good);
  }
  std::vector<Time> stamps;
  for (const Delivery& each : good) stamps.push_back(stamp_of(each.measurement));
  return stamps;
}

TEST(StampJumps, LetsRegularSamplesThrough) {
  StampJumps jumps(true);
  EXPECT_EQ(through(jumps, -1, 0).size(), 20U);
  EXPECT_EQ(jumps.dropped(), 0);
}

TEST(StampJumps, DropsASingleSampleFarAhead) {
  StampJumps jumps(true);
  const auto stamps = through(jumps, 7, 3 * kSecond);
  EXPECT_EQ(stamps.size(), 19U);
  EXPECT_LT(stamps.back(), kSecond);
  EXPECT_EQ(jumps.dropped(), 1);
  EXPECT_EQ(jumps.clock_jumps(), 0);
}

TEST(StampJumps, DropsAFirstSampleFarAhead) {
  StampJumps jumps(true);
  EXPECT_EQ(through(jumps, 0, 3 * kSecond).size(), 19U);
  EXPECT_EQ(jumps.dropped(), 1);
}

TEST(StampJumps, FollowsAClockThatWasSet) {
  StampJumps jumps(true);
  EXPECT_EQ(through(jumps, 7, kSecond, true).size(), 20U);
  EXPECT_EQ(jumps.dropped(), 0);
  EXPECT_EQ(jumps.clock_jumps(), 1);
}

TEST(StampJumps, LeavesSamplesFromThePastToOthers) {
  StampJumps jumps(true);
  EXPECT_EQ(through(jumps, 7, -3 * kSecond).size(), 20U);
}

TEST(StampJumps, LetsAGapThrough) {
  StampJumps jumps(false);
  std::vector<Delivery> good;
  jumps.take(imu(0, 0), good);
  jumps.take(imu(10 * kSecond, 10 * kSecond), good);
  EXPECT_EQ(good.size(), 2U);
}

TEST(StampJumps, TakesTheLargestStamps) {
  StampJumps jumps(false);
  std::vector<Delivery> good;
  jumps.take(imu(0, 0), good);
  jumps.take(imu(std::numeric_limits<Time>::max(), std::numeric_limits<Time>::min()), good);
  jumps.take(imu(1, 1), good);
  EXPECT_EQ(good.size(), 2U);
}

}  // namespace
}  // namespace aims
