// SPDX-License-Identifier: BSD-3-Clause
#include "estimator/baselines/lego_loam/lego_loam.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <memory>

#include "tests/estimator/baselines/room_scan.hpp"

namespace aims::lego_loam {
namespace {

using aims::testing::pose_of;
using aims::testing::position_error;
using aims::testing::room;
using aims::testing::rotation_error;
using aims::testing::scan_in;
using features::Keyframe;
using features::KeyframeMap;

const Pose kStart{Eigen::Quaterniond::Identity(), {0.3, -0.4, 0.6}};
const Pose kMotion = pose_of({0.08, 0.03, 0.01}, {0.004, -0.003, 0.02});
const test::CorridorShape kRoom = room(12.0, 9.0, 4.0);

SegmentedFeatures features_of(const LidarScan& scan) {
  FeatureConfig config;
  config.point_times = PointTimes::kMeasured;
  return segmented_features(RangeImage(scan, RangeImageConfig()), RangeImageConfig(), config);
}

LidarScan noisy_scan(const Pose& T_world_start, const Pose& motion, std::uint64_t seed) {
  return scan_in(kRoom, T_world_start, motion, {.noise = 0.01, .seed = seed});
}

/// Steps of the whole residual, so that one scan shows the motion.
OdometryConfig full_steps() {
  OdometryConfig config;
  config.matching.truncated_search = false;
  config.solver.residual_factor = 1.0;
  config.solver.stop_position = 1e-6;
  config.solver.stop_rotation_deg = 1e-5;
  return config;
}

TEST(LegoOdometry, FindsTheMotionInARoom) {
  TwoStepOdometry odometry(full_steps());
  SegmentedFeatures first = features_of(noisy_scan(kStart, Pose(), 1));
  odometry.update(first.features);
  SegmentedFeatures second = features_of(noisy_scan(kStart, kMotion, 2));
  const OdometryResult result = odometry.update(second.features);
  EXPECT_LT(position_error(odometry.pose(), kMotion), 0.04) << "seeds 1, 2";
  EXPECT_LT(rotation_error(odometry.pose(), kMotion), 0.02);
  EXPECT_GT(result.ground.planes, 30);
  EXPECT_GT(result.edges.lines, 30);
}

TEST(LegoOdometry, TheFirstStepLeavesHeadingAndPlane) {
  TwoStepOdometry odometry(full_steps());
  SegmentedFeatures first = features_of(noisy_scan(kStart, Pose(), 1));
  odometry.update(first.features);
  SegmentedFeatures second = features_of(noisy_scan(kStart, kMotion, 2));
  second.features.sharp.clear();
  const OdometryResult result = odometry.update(second.features);
  EXPECT_EQ(result.edges.iterations, 0);
  EXPECT_GT(result.ground.iterations, 0);
  EXPECT_NEAR(odometry.pose().translation.head<2>().norm(), 0.0, 1e-12);
  EXPECT_LT(std::abs(so3_log(odometry.pose().rotation).z()), 1e-3);
}

Keyframe keyframe_at(double x) {
  Keyframe keyframe;
  keyframe.T_map_lidar.translation = {x, 0.5, 0.5};
  keyframe.edges = {{{1.0F, 0.0F, 0.0F}}};
  keyframe.planes = {{{0.0F, 1.0F, 0.0F}}};
  return keyframe;
}

TEST(LegoKeyframeMap, UsesOneKeyframePerVoxelWithinTheRadius) {
  KeyframeMap map;
  for (int i = 0; i < 100; ++i) map.add(keyframe_at(0.25 + 0.5 * i));
  const std::vector<int> near = map.near({0.0, 0.5, 0.5}, 10.0, 1.0);
  ASSERT_EQ(near.size(), 10U);
  for (std::size_t i = 0; i < near.size(); ++i) EXPECT_EQ(near[i], static_cast<int>(2 * i));
}

TEST(LegoKeyframeMap, OnTheReturnAVoxelYieldsTheKeyframeOfItsMeanIndex) {
  KeyframeMap map;
  for (const double x : {0.5, 10.5, 20.5, 10.5, 0.5}) map.add(keyframe_at(x));
  const std::vector<int> near = map.near({0.5, 0.5, 0.5}, 1.0, 1.0);
  ASSERT_EQ(near.size(), 1U);
  EXPECT_EQ(near[0], 2);  // the far end, as in the published program
}

TEST(LegoKeyframeMap, OnTheReturnAVoxelYieldsTheKeyframeNearItsMeanPosition) {
  KeyframeMap map;
  for (const double x : {0.5, 10.5, 20.5, 10.5, 0.9, 0.9}) map.add(keyframe_at(x));
  EXPECT_EQ(map.near_means({0.5, 0.5, 0.5}, 1.0, 1.0), std::vector<int>{4});
  EXPECT_EQ(map.near_means({0.5, 0.5, 0.5}, 12.0, 10.0), (std::vector<int>{4, 1}));
}

TEST(LegoKeyframeMap, SubmapIsInMapAxes) {
  KeyframeMap map;
  map.add(keyframe_at(3.0));
  const KeyframeMap::Submap submap = map.submap({0});
  EXPECT_EQ(submap.edges[0].position, Eigen::Vector3f(4.0F, 0.5F, 0.5F));
  EXPECT_EQ(submap.planes[0].position, Eigen::Vector3f(3.0F, 1.5F, 0.5F));
}

TEST(LegoMapping, CorrectsTheOdometryInARoom) {
  MappingConfig config;
  config.every_nth = 1;
  Mapping mapping(config);
  ASSERT_TRUE(mapping.update(0, Pose(), features_of(noisy_scan(kStart, Pose(), 1))));
  const Pose drifted = kMotion * pose_of({0.05, -0.04, 0.03}, {0.005, 0.005, -0.01});
  ASSERT_TRUE(
      mapping.update(kSecond, drifted, features_of(noisy_scan(kStart * kMotion, Pose(), 2))));
  EXPECT_LT(position_error(mapping.to_map(drifted), kMotion), 0.02) << "seeds 1, 2";
  EXPECT_LT(rotation_error(mapping.to_map(drifted), kMotion), 0.005);
}

TEST(LegoMapping, RegistersEverySecondScanAfterTheInterval) {
  Mapping mapping((MappingConfig()));
  std::vector<int> registered;
  const SegmentedFeatures scan = features_of(noisy_scan(kStart, Pose(), 1));
  for (int i = 0; i < 10; ++i) {
    if (mapping.update(i * 100 * kMillisecond, Pose(), scan)) registered.push_back(i);
  }
  EXPECT_EQ(registered, (std::vector<int>{0, 4, 8}));
}

// 1.0 s - 0.7 s is less than 0.3 s in double precision, 0.7 s - 0.4 s is not.
TEST(LegoMapping, MeasuresTheIntervalInRoundedSeconds) {
  MappingConfig config;
  config.every_nth = 1;
  Mapping mapping(config);
  std::vector<int> registered;
  const SegmentedFeatures scan = features_of(noisy_scan(kStart, Pose(), 1));
  for (int i = 1; i < 20; ++i) {
    if (mapping.update(i * 100 * kMillisecond, Pose(), scan)) registered.push_back(i);
  }
  EXPECT_EQ(registered, (std::vector<int>{1, 4, 7, 11, 15, 18}));
}

/// Scans of a LiDAR that moves steadily, one in 100 ms.
EstimatorResult run(const Config& config, const SensorRig& rig, int scans) {
  LegoLoam estimator(config, rig);
  Pose T_world_lidar = kStart;
  for (int i = 0; i < scans; ++i) {
    auto scan = std::make_shared<LidarScan>(
        noisy_scan(T_world_lidar, kMotion, static_cast<std::uint64_t>(i + 1)));
    scan->stamp += i * 100 * kMillisecond;
    scan->end += i * 100 * kMillisecond;
    T_world_lidar = T_world_lidar * kMotion;
    estimator.consume({scan->end, LidarScanPtr(scan)});
  }
  estimator.finish();
  return estimator.result();
}

TEST(LegoLoam, ReportsThePoseOfTheBody) {
  SensorRig rig;
  rig.T_body_lidar = pose_of({0.2, 0.0, 0.1}, {0.0, 0.1, 0.5});
  const EstimatorResult in_lidar_axes = run(corridor(), SensorRig(), 3);
  const EstimatorResult result = run(corridor(), rig, 3);
  ASSERT_EQ(result.trajectory.size(), 3U);
  for (std::size_t i = 0; i < 3; ++i) {
    const Pose expected =
        rig.T_body_lidar * in_lidar_axes.trajectory[i].pose * rig.T_body_lidar.inverse();
    EXPECT_LT(position_error(result.trajectory[i].pose, expected), 1e-12);
  }
  EXPECT_LT(position_error(result.trajectory[0].pose, Pose()), 1e-12);
}

TEST(LegoLoam, ReportsItsOwnDegeneracy) {
  const EstimatorResult result = run(corridor(), SensorRig(), 3);
  const Diagnostics& diagnostics = result.diagnostics;
  ASSERT_EQ(diagnostics.scans.size(), 3U);
  EXPECT_FALSE(diagnostics.updated(0));
  EXPECT_TRUE(diagnostics.updated(1));
  EXPECT_GT(diagnostics.value(1, "ground_smallest_eigenvalue"), 0.0);
  EXPECT_GT(diagnostics.value(1, "edge_smallest_eigenvalue"), 0.0);
  EXPECT_GE(diagnostics.value(1, "odometry_removed_directions"), 0.0);
  EXPECT_TRUE(std::isnan(diagnostics.value(2, "mapping_matches")));
}

}  // namespace
}  // namespace aims::lego_loam
