// SPDX-License-Identifier: BSD-3-Clause
#include "estimator/baselines/leg_kilo/scan_groups.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace aims::leg_kilo {
namespace {

LidarScan scan_of(std::vector<LidarPoint> points) {
  return {.stamp = kSecond, .end = kSecond + kSecond / 10, .points = std::move(points)};
}

LidarPoint point_at(float x, double offset_ms) {
  return {.position = {x, 0.0F, 0.0F},
          .time_offset_ns = static_cast<std::int32_t>(std::lround(1e6 * offset_ms))};
}

Points every_point() { return {.every_nth = 1, .min_range = 0.5, .voxel = 0.3}; }

TEST(LegKiloGroups, FiringTimesAreRoundedFromTheFirstReturnOn) {
  const LidarScan scan = scan_of({point_at(0.1F, 1.0), point_at(2.0F, 1.9), point_at(4.0F, 2.1),
                                  point_at(6.0F, 3.9), point_at(8.0F, 4.1)});
  EXPECT_EQ(first_firing(scan), scan.stamp + kMillisecond);
  EXPECT_EQ(last_firing(scan), scan.stamp + 41 * kMillisecond / 10);
  const std::vector<TimedPoint> points = timed_points(scan, every_point());
  ASSERT_EQ(points.size(), 4U);  // the first one is too near
  EXPECT_FLOAT_EQ(points[0].w(), 0.0F);
  EXPECT_FLOAT_EQ(points[1].w(), 2e-3F);
  EXPECT_FLOAT_EQ(points[2].w(), 2e-3F);
  EXPECT_FLOAT_EQ(points[3].w(), 4e-3F);
}

TEST(LegKiloGroups, PointsOfOneInstantAreOneGroupInOrderOfTime) {
  const LidarScan scan = scan_of(
      {point_at(8.0F, 0.0), point_at(2.0F, 2.1), point_at(4.0F, 2.2), point_at(-6.0F, 8.0)});
  const std::vector<PointGroup> groups = point_groups(scan, every_point());
  ASSERT_EQ(groups.size(), 3U);
  EXPECT_EQ(groups[0].stamp, scan.stamp);
  EXPECT_NEAR(static_cast<double>(groups[1].stamp - scan.stamp), 2e6, 1.0);
  EXPECT_EQ(groups[1].points.size(), 2U);
  EXPECT_NEAR(static_cast<double>(groups[2].stamp - scan.stamp), 8e6, 1.0);
  EXPECT_NEAR(groups[2].points[0].x(), -6.0, 1e-6);
}

TEST(LegKiloGroups, AVoxelHasTheMeanTimeOfItsPoints) {
  const LidarScan scan = scan_of(
      {point_at(8.0F, 0.0), point_at(2.12F, 2.0), point_at(2.2F, 4.0), point_at(2.28F, 6.0)});
  const std::vector<PointGroup> groups = point_groups(scan, every_point());
  ASSERT_EQ(groups.size(), 2U);
  EXPECT_NEAR(static_cast<double>(groups[1].stamp - scan.stamp), 4e6, 1.0);
  ASSERT_EQ(groups[1].points.size(), 1U);
  EXPECT_NEAR(groups[1].points[0].x(), 2.2, 1e-6);
}

TEST(LegKiloGroups, AScanWithoutPointsHasNoGroup) {
  EXPECT_TRUE(point_groups(scan_of({}), every_point()).empty());
  EXPECT_EQ(last_firing(scan_of({})), scan_of({}).end);
}

}  // namespace
}  // namespace aims::leg_kilo
