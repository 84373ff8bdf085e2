// SPDX-License-Identifier: BSD-3-Clause
#include "bench/estimate/lidar_odometry.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

namespace aims {
namespace {

constexpr Duration kScanTime = 100 * kMillisecond;

/// A body that rocks by 0.1 rad at 2 Hz, turns at 0.5 rad/s and walks at 0.5 m/s.
Pose pose_at(Time stamp) {
  const double t = to_seconds(stamp);
  return {yaw_rotation(0.5 * t) * so3_exp({0.1 * std::sin(4.0 * M_PI * t), 0.0, 0.0}),
          {0.5 * t - 1.0, 0.0, 0.0}};
}

/// Distance to the walls of a room around the origin along a unit vector [m].
double range_in_room(const Eigen::Vector3d& from, const Eigen::Vector3d& along) {
  const Eigen::Vector3d half(6.0, 4.0, 1.5);
  double range = 1e3;
  for (int axis = 0; axis < 3; ++axis) {
    if (std::abs(along[axis]) < 1e-9) continue;
    const double wall = along[axis] > 0.0 ? half[axis] : -half[axis];
    range = std::min(range, (wall - from[axis]) / along[axis]);
  }
  return range;
}

/// A scan in directions that follow no rings, each return from the pose at its firing.
LidarScan scan_at(Time begin, std::mt19937& random, int returns) {
  std::uniform_real_distribution<double> height(-0.8, 0.8);
  std::normal_distribution<double> noise(0.0, 0.01);
  LidarScan scan{begin, begin + kScanTime, {}};
  for (int i = 0; i < returns; ++i) {
    const Duration offset = kScanTime * i / returns;
    const Pose pose = pose_at(begin + offset);
    const double azimuth = 2.0 * M_PI * i / returns * 7.0;
    const double z = height(random);
    const double level = std::sqrt(1.0 - z * z);
    const Eigen::Vector3d along(level * std::cos(azimuth), level * std::sin(azimuth), z);
    const double range = range_in_room(pose.translation, pose.rotation * along) + noise(random);
    LidarPoint point;
    point.position = (range * along).cast<float>();
    point.time_offset_ns = static_cast<std::int32_t>(offset);
    scan.points.push_back(point);
  }
  return scan;
}

TEST(LidarOdometry, FollowsABodyThatRocksAndTurnsWithoutRings) {
  std::mt19937 random(3);
  LidarOdometry odometry;
  for (int i = 0; i < 40; ++i) odometry.add(scan_at(i * kScanTime, random, 6000));
  ASSERT_EQ(odometry.paths().size(), 1U);
  const Trajectory& path = odometry.paths().front();
  ASSERT_EQ(path.size(), 40U);
  const Pose T_room_start = pose_at(path.front().stamp);
  double rotation = 0.0, position = 0.0;
  for (const StampedPose& each : path) {
    const Pose truth = T_room_start.inverse() * pose_at(each.stamp);
    rotation = std::max(rotation, truth.rotation.angularDistance(each.pose.rotation));
    position = std::max(position, (truth.translation - each.pose.translation).norm());
  }
  EXPECT_LT(rotation, 0.01) << "a rigid scan turns by 0.05 rad";
  EXPECT_LT(position, 0.03);
}

TEST(LidarOdometry, BeginsANewPathWhereAScanHasNoPlanes) {
  std::mt19937 random(3);
  LidarOdometry odometry;
  for (int i = 0; i < 5; ++i) odometry.add(scan_at(i * kScanTime, random, 6000));
  odometry.add(scan_at(5 * kScanTime, random, 5));
  for (int i = 6; i < 9; ++i) odometry.add(scan_at(i * kScanTime, random, 6000));
  ASSERT_EQ(odometry.paths().size(), 2U);
  EXPECT_EQ(odometry.paths()[0].size(), 5U);
  EXPECT_EQ(odometry.paths()[1].size(), 3U);
}

}  // namespace
}  // namespace aims
