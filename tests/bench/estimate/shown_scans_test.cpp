// SPDX-License-Identifier: BSD-3-Clause
#include "bench/estimate/shown_scans.hpp"

#include <gtest/gtest.h>

#include <set>

namespace aims {
namespace {

TEST(ShownScans, IndicesAreSpreadOverTheScanAndOverItsRings) {
  constexpr std::size_t kCount = 28800;
  constexpr std::size_t kRings = 16;
  const auto indices = spread_indices(kCount, kMostShownReturns);
  ASSERT_EQ(indices.size(), kMostShownReturns);
  std::vector<std::size_t> per_ring(kRings, 0);
  for (std::size_t i = 0; i < indices.size(); ++i) {
    EXPECT_EQ(indices[i] * kMostShownReturns / kCount, i) << "one in each part";
    ++per_ring[indices[i] % kRings];
  }
  for (const std::size_t count : per_ring) EXPECT_NEAR(static_cast<double>(count), 25.0, 8.0);
}

TEST(ShownScans, OfFewReturnsAllAreKept) {
  EXPECT_EQ(spread_indices(3, 400), (std::vector<std::size_t>{0, 1, 2}));
  EXPECT_TRUE(spread_indices(0, 400).empty());
}

/// A body that walks along +x at 2 m/s while it turns left at 1 rad/s.
Trajectory walk() {
  Trajectory truth;
  for (int i = 0; i <= 400; ++i) {
    const double t = 0.0025 * i;
    truth.push_back({from_seconds(t), {yaw_rotation(t), {2.0 * t, 0.0, 0.3}}});
  }
  return truth;
}

TEST(ShownScans, ReturnsOfOneSpotStandOnOneSpot) {
  const Trajectory truth = walk();
  const Pose T_body_lidar = {yaw_rotation(0.2), {0.1, 0.0, 0.15}};
  const Eigen::Vector3d spot(6.0, 1.5, 0.8);
  LidarScan scan;
  scan.stamp = from_seconds(0.5);
  scan.end = from_seconds(0.6);
  for (int i = 0; i < 40; ++i) {
    LidarPoint point;
    point.time_offset_ns = 2500000 * i;
    point.intensity = 0.25F;
    const Pose T_world_lidar = *pose_at(truth, scan.stamp + point.time_offset_ns) * T_body_lidar;
    point.position = (T_world_lidar.inverse() * spot).cast<float>();
    scan.points.push_back(point);
  }
  const ShownScan shown = shown_scan(scan, truth, T_body_lidar);
  EXPECT_EQ(shown.stamp, scan.end);
  EXPECT_EQ(shown.returns, 40U);
  ASSERT_EQ(shown.shown.size(), 40U);
  const Eigen::Vector3f expected = (pose_at(truth, scan.end)->inverse() * spot).cast<float>();
  for (const ShownReturn& each : shown.shown) {
    EXPECT_LT((each.p_body - expected).norm(), 1e-4F);
    EXPECT_EQ(each.intensity, 0.25F);
  }
}

TEST(ShownScans, OutsideTheTruthNothingIsPlaced) {
  LidarScan scan;
  scan.stamp = from_seconds(0.95);
  scan.end = from_seconds(1.05);
  scan.points.resize(5);
  EXPECT_TRUE(shown_scan(scan, walk(), {}).shown.empty());
}

/// Scans at 10 Hz of a body at rest, whose poses begin after 10 s.
std::vector<ShownScan> kept_of(double seconds) {
  Trajectory poses;
  for (double t = 10.0; t < seconds + 1.0; t += 0.5) poses.push_back({from_seconds(t), Pose{}});
  ScanKeeper keeper(from_seconds(seconds));
  for (int i = 0; i < 10.0 * seconds; ++i) {
    LidarScan scan;
    scan.stamp = i * 100 * kMillisecond;
    scan.end = scan.stamp + 100 * kMillisecond;
    scan.points.resize(1000);
    for (LidarPoint& point : scan.points) point.position.x() = static_cast<float>(i);
    keeper.add(scan);
  }
  return keeper.shown(poses, {});
}

TEST(ShownScans, OfAStreamSomeAreKeptAtEvenDistances) {
  const auto few = kept_of(30.0);
  ASSERT_EQ(few.size(), 20U);  // at 10.1, 11.1, ... s: those before have no poses
  EXPECT_EQ(few.front().stamp, from_seconds(10.1));
  EXPECT_EQ(few.front().returns, 1000U);
  ASSERT_EQ(few.front().shown.size(), kMostShownReturns);
  EXPECT_EQ(few.front().shown[7].p_body.x(), 100.0F);
  const auto many = kept_of(1200.0);
  ASSERT_LE(many.size(), kMostShownScans);
  ASSERT_GT(many.size(), kMostShownScans - 5);
  for (std::size_t i = 1; i < many.size(); ++i) {
    EXPECT_EQ(many[i].stamp - many[i - 1].stamp, 5 * kSecond);
  }
}

TEST(ShownScans, TheTableHasARowPerReturnInMillimetres) {
  const std::vector<ShownScan> scans = {
      {from_seconds(1.5), 28000, {{{1.23456F, -0.5F, 0.0F}, 0.256F}, {{2.0F, 0.0F, 1.0F}, 1.0F}}}};
  EXPECT_EQ(shown_scans_table(scans).text(),
            "stamp_s,returns,x,y,z,intensity\n"
            "1.5,28000,1.235,-0.5,0,0.26\n"
            "1.5,28000,2,0,1,1\n");
}

}  // namespace
}  // namespace aims
