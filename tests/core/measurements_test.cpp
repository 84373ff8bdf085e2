// SPDX-License-Identifier: BSD-3-Clause
#include "core/measurements.hpp"

#include <gtest/gtest.h>

namespace aims {
namespace {

TEST(StampOf, IsTheEndOfTheMeasurement) {
  ImuSample imu;
  imu.stamp = 5;
  LegOdometrySample leg;
  leg.stamp = 7;
  auto scan = std::make_shared<LidarScan>();
  scan->stamp = 100;
  scan->end = 200;
  EXPECT_EQ(stamp_of(imu), 5);
  EXPECT_EQ(stamp_of(leg), 7);
  EXPECT_EQ(stamp_of(LidarScanPtr(scan)), 200);
}

}  // namespace
}  // namespace aims
