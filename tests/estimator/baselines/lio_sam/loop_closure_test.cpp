// SPDX-License-Identifier: BSD-3-Clause
#include "estimator/baselines/lio_sam/loop_closure.hpp"

#include <gtest/gtest.h>

#include "core/random.hpp"
#include "estimator/baselines/lio_sam/icp.hpp"
#include "tests/estimator/baselines/room_scan.hpp"

namespace aims::lio_sam {
namespace {

using aims::testing::pose_of;
using aims::testing::position_error;
using aims::testing::rotation_error;
using Eigen::Vector3f;

/// Points on three walls that meet in a corner.
std::vector<Vector3f> corner(int count, std::uint64_t seed) {
  RandomStream random(seed, "icp_test");
  std::vector<Vector3f> points;
  for (int i = 0; i < count; ++i) {
    Eigen::Vector3d p(random.uniform(0.0, 4.0), random.uniform(0.0, 3.0), random.uniform(0.0, 2.0));
    p[i % 3] = 0.0;
    points.push_back(p.cast<float>());
  }
  return points;
}

std::vector<Vector3f> moved(const std::vector<Vector3f>& points, const Pose& pose) {
  std::vector<Vector3f> result;
  for (const Vector3f& p : points) result.push_back((pose * p.cast<double>()).cast<float>());
  return result;
}

TEST(LioSamIcp, FindsTheMotionOfACloud) {
  const Pose motion = pose_of({0.1, -0.08, 0.05}, {0.02, -0.01, 0.03});
  const auto cloud = corner(6000, 1);
  features::PointIndex target;
  target.build(cloud);
  const IcpResult found = align(moved(corner(600, 1), motion), target, 5.0);
  EXPECT_LT(position_error(found.T_target_source, motion.inverse()), 2e-3);
  EXPECT_LT(rotation_error(found.T_target_source, motion.inverse()), 2e-3);
  EXPECT_LT(found.fitness, 1e-4);
  EXPECT_GT(found.iterations, 3);
}

TEST(LioSamIcp, FitnessIsTheMeanSquaredDistance) {
  features::PointIndex target;
  target.build({{0.0F, 0.0F, 0.0F}, {10.0F, 0.0F, 0.0F}});
  const IcpResult found = align({{0.0F, 1.0F, 0.0F}, {10.0F, 2.0F, 0.0F}}, target, 0.5);
  EXPECT_EQ(found.iterations, 0) << "all points are too far";
  EXPECT_NEAR(found.fitness, 2.5, 1e-6);
}

features::Keyframe keyframe(const Pose& T_map_lidar, double seconds) {
  features::Keyframe result;
  result.T_map_lidar = T_map_lidar;
  result.stamp = from_seconds(seconds);
  const Pose T_lidar_map = T_map_lidar.inverse();
  for (const Vector3f& p : corner(6000, 3)) {
    result.planes.push_back({(T_lidar_map * p.cast<double>()).cast<float>()});
  }
  return result;
}

LoopConfig config() {
  LoopConfig config;
  config.voxel = 0.1;
  config.keyframes = 1;
  return config;
}

/// Three keyframes; the last one, back at the first, believes that it is `error` off.
features::KeyframeMap round_trip(const Pose& error) {
  features::KeyframeMap map;
  map.add(keyframe(pose_of({1.0, 1.0, 1.0}, {0.0, 0.0, 0.0}), 0.0));
  map.add(keyframe(pose_of({1.5, 1.0, 1.0}, {0.0, 0.0, 0.1}), 20.0));
  const Pose truth = pose_of({1.2, 1.0, 1.0}, {0.0, 0.0, 0.05});
  features::Keyframe last = keyframe(truth, 40.0);
  last.T_map_lidar = error * truth;
  map.add(std::move(last));
  return map;
}

const Pose kError = pose_of({0.15, -0.1, 0.05}, {0.01, 0.02, -0.02});

TEST(LioSamLoopClosure, MeasuresTheNewestKeyframeFromAnOldOne) {
  LoopClosure loops(config());
  loops.search(from_seconds(40.0), round_trip(kError));
  const std::vector<Loop> found = loops.take_found();
  ASSERT_EQ(found.size(), 1U);
  EXPECT_EQ(found[0].newer, 2);
  EXPECT_EQ(found[0].older, 0) << "the nearest that is older than 30 s";
  const Pose expected = pose_of({1.2, 1.0, 1.0}, {0.0, 0.0, 0.05}).inverse() *
                        pose_of({1.0, 1.0, 1.0}, {0.0, 0.0, 0.0});
  EXPECT_LT(position_error(found[0].T_newer_older, expected), 0.01);
  EXPECT_LT(rotation_error(found[0].T_newer_older, expected), 0.01);
  EXPECT_TRUE(loops.take_found().empty());
  loops.search(from_seconds(42.0), round_trip(kError));
  EXPECT_EQ(loops.closed(), 1) << "one loop per keyframe";
}

TEST(LioSamLoopClosure, LeavesOutYoungFarAndPoorMatches) {
  LoopConfig young = config();
  young.min_age = 41.0;
  LoopConfig far = config();
  far.radius = 0.1;
  LoopConfig poor = config();
  poor.max_fitness = 1e-9;
  LoopConfig off = config();
  off.enabled = false;
  for (const LoopConfig& each : {young, far, poor, off}) {
    LoopClosure loops(each);
    loops.search(from_seconds(40.0), round_trip(kError));
    EXPECT_EQ(loops.closed(), 0);
  }
}

}  // namespace
}  // namespace aims::lio_sam
