// SPDX-License-Identifier: BSD-3-Clause
#include "sim/links/link.hpp"

#include <gtest/gtest.h>

#include <memory>

namespace aims {
namespace {

LegOdometrySample leg_sample(Time stamp) {
  LegOdometrySample sample;
  sample.stamp = stamp;
  return sample;
}

ImuSample imu_sample(Time stamp) {
  ImuSample sample;
  sample.stamp = stamp;
  return sample;
}

TEST(Arrivals, ComeInOrderOfArrivalThenKindThenSending) {
  Arrivals arrivals;
  arrivals.add({20, LidarScanPtr(std::make_shared<LidarScan>())});
  arrivals.add({20, leg_sample(1)});
  arrivals.add({20, leg_sample(2)});
  arrivals.add({20, imu_sample(3)});
  arrivals.add({10, leg_sample(4)});
  std::vector<Delivery> out;
  arrivals.take(20, out);
  ASSERT_EQ(out.size(), 5U);
  EXPECT_EQ(std::get<LegOdometrySample>(out[0].measurement).stamp, 4);
  EXPECT_EQ(std::get<ImuSample>(out[1].measurement).stamp, 3);
  EXPECT_EQ(std::get<LegOdometrySample>(out[2].measurement).stamp, 1);
  EXPECT_EQ(std::get<LegOdometrySample>(out[3].measurement).stamp, 2);
  EXPECT_TRUE(std::holds_alternative<LidarScanPtr>(out[4].measurement));
}

TEST(Arrivals, KeepPendingPackets) {
  Arrivals arrivals;
  arrivals.add({30, imu_sample(5)});
  std::vector<Delivery> out;
  arrivals.take(29, out);
  EXPECT_TRUE(out.empty());
  arrivals.take(30, out);
  EXPECT_EQ(out.size(), 1U);
}

}  // namespace
}  // namespace aims
