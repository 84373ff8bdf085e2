// SPDX-License-Identifier: BSD-3-Clause
#include "estimator/lidar/scan_points.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>

namespace aims {
namespace {

const Pose kT_body_lidar{so3_exp({0.0, 0.0, 0.5}), {0.2, 0.0, 0.3}};

/// 16 rings of 900 returns, 3 m away; with `post` those within 8 deg of the x axis 1.5 m away. One
/// more is out of range.
LidarScan scan_at(Time stamp, bool post = false) {
  LidarScan scan;
  scan.stamp = stamp;
  scan.end = stamp + kSecond / 10;
  for (int column = 0; column < 900; ++column) {
    const double azimuth = (0.4 * column - 180.0) * std::numbers::pi / 180.0;
    for (int ring = 0; ring < 16; ++ring) {
      const double elevation = (2.0 * ring - 15.0) * std::numbers::pi / 180.0;
      const Eigen::Vector3d ray(std::cos(elevation) * std::cos(azimuth),
                                std::cos(elevation) * std::sin(azimuth), std::sin(elevation));
      const double range = post && std::abs(azimuth) < 0.14 ? 1.5 : 3.0;
      scan.points.push_back(
          {(range * ray).cast<float>(), 0.5F, column, static_cast<std::uint16_t>(ring)});
    }
  }
  scan.points.push_back({Eigen::Vector3f(500.0F, 0.0F, 0.0F), 0.5F, 900, 0});
  return scan;
}

ScanMotion standing() {
  ScanMotion motion;
  motion.assign(NominalState{}, {}, kT_body_lidar, 9.81);
  return motion;
}

ScanPoints points_with(double selection_voxel, double insertion_voxel) {
  LidarUpdateConfig lidar;
  lidar.selection_voxel = selection_voxel;
  lidar.max_points = 100000;
  MapConfig map;
  map.insertion_voxel = insertion_voxel;
  return {lidar, map, kT_body_lidar.translation};
}

/// Whether each of `few` is among `many`.
bool contains_all(const std::vector<Eigen::Vector3f>& many,
                  const std::vector<Eigen::Vector3f>& few) {
  return std::ranges::all_of(
      few, [&](const Eigen::Vector3f& p) { return std::ranges::find(many, p) != many.end(); });
}

TEST(ScanPoints, TellWhichLimitLeavesMostReturnsOut) {
  const auto left_out = [](double min_range, double max_range) {
    LidarUpdateConfig lidar;
    lidar.min_range = min_range;
    lidar.max_range = max_range;
    ScanPoints points(lidar, {}, kT_body_lidar.translation);
    const LidarScan scan = scan_at(0);
    points.prepare(scan, standing(), {});
    return points.left_out(scan);
  };
  EXPECT_EQ(left_out(0.3, 120.0), LeftOutByRange::kFew);
  EXPECT_EQ(left_out(0.3, 2.0), LeftOutByRange::kTooFar);
  EXPECT_EQ(left_out(4.0, 120.0), LeftOutByRange::kTooNear);
}

TEST(ScanPoints, AreInBodyAxes) {
  ScanPoints points = points_with(0.25, 0.1);
  points.prepare(scan_at(0), standing(), Pose());
  EXPECT_EQ(points.in_range(), 14400);
  ASSERT_GT(points.to_match().size(), 500U);
  const Eigen::Vector3f sensor = kT_body_lidar.translation.cast<float>();
  for (const Eigen::Vector3f& point : points.to_match()) {
    EXPECT_NEAR((point - sensor).norm(), 3.0F, 1e-4F);
  }
}

TEST(ScanPoints, OfTheCoarserVoxelsAreAmongThoseOfTheFinerOnes) {
  ScanPoints fine_map = points_with(0.5, 0.2);
  ScanPoints coarse_map = points_with(0.2, 0.5);
  const LidarScan scan = scan_at(0);
  fine_map.prepare(scan, standing(), Pose());
  coarse_map.prepare(scan, standing(), Pose());
  EXPECT_GT(fine_map.to_map().size(), 2 * fine_map.to_match().size());
  EXPECT_TRUE(contains_all(fine_map.to_map(), fine_map.to_match()));
  EXPECT_EQ(coarse_map.to_match(), fine_map.to_map());
  EXPECT_EQ(coarse_map.to_map(), fine_map.to_match());
}

TEST(ScanPoints, LeaveOutWhatCameSinceEarlierScans) {
  ScanPoints points = points_with(0.25, 0.1);
  for (int i = 0; i < 12; ++i) {
    points.prepare(scan_at(i * kSecond / 10), standing(), Pose());
    EXPECT_EQ(points.moving(), 0) << "nothing moves";
    points.keep(Pose());
  }
  points.prepare(scan_at(12 * kSecond / 10, true), standing(), Pose());
  EXPECT_GT(points.moving(), 30) << "one per voxel of 0.1 m";
  const Eigen::Vector3f sensor = kT_body_lidar.translation.cast<float>();
  const auto near = [&](const Eigen::Vector3f& p) { return (p - sensor).norm() < 2.0F; };
  EXPECT_TRUE(std::ranges::none_of(points.to_match(), near));
  EXPECT_TRUE(std::ranges::none_of(points.to_map(), near));
}

}  // namespace
}  // namespace aims
