// SPDX-License-Identifier: BSD-3-Clause
#include "estimator/baselines/loam/loam.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <memory>

#include "tests/estimator/baselines/room_scan.hpp"

namespace aims::loam {
namespace {

using aims::testing::open_corridor;
using aims::testing::pose_of;
using aims::testing::position_error;
using aims::testing::room;
using aims::testing::rotation_error;
using aims::testing::scan_in;

/// Tilted: the rings of a level LiDAR hardly constrain its height.
const Pose kStart = pose_of({0.3, -0.4, 1.4}, {0.2, 0.3, 0.1});
const Pose kMotion = pose_of({0.10, 0.03, -0.02}, {0.01, -0.008, 0.03});
const test::CorridorShape kRoom = room(12.0, 9.0, 4.0);

features::RingFeatures features_of(const LidarScan& scan) {
  return features::ring_features(scan, features::RingFeatureConfig());
}

/// Steps of the whole residual, so that one scan shows the motion.
ScanToScanConfig full_steps() {
  ScanToScanConfig config;
  config.solver.residual_factor = 1.0;
  config.solver.max_iterations = 50;
  config.solver.stop_position = 1e-6;
  config.solver.stop_rotation_deg = 1e-5;
  return config;
}

/// The motion that the odometry finds after a scan at rest, in a scan during `motion`.
Pose found_motion(const ScanToScanConfig& config, const test::CorridorShape& shape,
                  const LidarScan& second) {
  ScanToScan odometry(config);
  features::RingFeatures first = features_of(scan_in(shape, kStart));
  odometry.update(first);
  features::RingFeatures features = features_of(second);
  odometry.update(features);
  return odometry.pose();
}

TEST(LoamScanToScan, FindsTheMotionDuringAScanInARoom) {
  const Pose found = found_motion(full_steps(), kRoom, scan_in(kRoom, kStart, kMotion));
  EXPECT_LT(position_error(found, kMotion), 0.005);
  EXPECT_LT(rotation_error(found, kMotion), 0.002);
}

TEST(LoamScanToScan, ARigidScanNeedsNoDeskewing) {
  ScanToScanConfig config = full_steps();
  config.deskew = false;
  const Pose found = found_motion(config, kRoom, scan_in(kRoom, kStart * kMotion));
  EXPECT_LT(position_error(found, kMotion), 0.005);
  EXPECT_LT(rotation_error(found, kMotion), 0.002);
}

TEST(LoamScanToScan, ALoamFindsTheMotionBetweenRigidScans) {
  const Pose found = found_motion(a_loam().odometry, kRoom, scan_in(kRoom, kStart * kMotion));
  EXPECT_LT(position_error(found, kMotion), 0.005);
  EXPECT_LT(rotation_error(found, kMotion), 0.002);
}

TEST(LoamScanToScan, ThePublishedFactorLeavesAPartOfTheMotion) {
  ScanToScanConfig config = Config().odometry;
  const Pose found = found_motion(config, kRoom, scan_in(kRoom, kStart, kMotion));
  EXPECT_GT(position_error(found, kMotion), 0.1 * kMotion.translation.norm());
  EXPECT_LT(position_error(found, kMotion), kMotion.translation.norm());
}

TEST(LoamScanToScan, TheFreeDirectionOfACorridorDoesNotMove) {
  ScanToScanConfig config = full_steps();
  config.deskew = false;
  config.min_edges = 0;
  const test::CorridorShape corridor = open_corridor();
  ScanToScan odometry(config);
  features::RingFeatures first = features_of(scan_in(corridor, kStart));
  odometry.update(first);
  const Eigen::Vector3d shift(0.2, 0.02, -0.01);  // world axes
  const Pose motion{Eigen::Quaterniond::Identity(), kStart.rotation.conjugate() * shift};
  features::RingFeatures second = features_of(scan_in(corridor, kStart * motion));
  second.sharp.clear();
  const features::SolverResult result = odometry.update(second);
  EXPECT_EQ(result.directions.removed, 1);
  const Eigen::Vector3d found = kStart.rotation * result.pose.translation;
  EXPECT_NEAR(found.x(), 0.0, 0.015);
  EXPECT_NEAR(found.y(), shift.y(), 0.005);
  EXPECT_NEAR(found.z(), shift.z(), 0.015);
}

TEST(LoamScanToScan, MovedPointsLieWhereTheScanEnds) {
  features::FeatureCloud cloud;
  for (const LidarPoint& point : scan_in(kRoom, kStart, kMotion, {.columns = 60}).points) {
    cloud.push_back({point.position, static_cast<float>(point.time_offset_ns) / 1e8F, point.ring});
  }
  features::move_to_scan_end(cloud, kMotion);
  for (const features::FeaturePoint& point : cloud) {
    const Eigen::Vector3d p = kStart * kMotion * point.position.cast<double>();
    const double off_wall =
        std::min({6.0 - std::abs(p.x()), 4.5 - std::abs(p.y()), std::abs(p.z()), 4.0 - p.z()});
    EXPECT_NEAR(off_wall, 0.0, 1e-4);
  }
}

void expect_corrected(const ScanToMapConfig& config) {
  ScanToMap mapping(config);
  for (const double x : {0.0, 0.05, 0.1}) {
    const Pose shift{Eigen::Quaterniond::Identity(), {x, 0.0, 0.0}};
    mapping.update(shift, features_of(scan_in(kRoom, kStart * shift)));
  }
  const Pose drifted = kMotion * pose_of({0.06, -0.05, 0.04}, {0.01, 0.01, -0.01});
  mapping.update(drifted, features_of(scan_in(kRoom, kStart * kMotion)));
  EXPECT_LT(position_error(mapping.to_map(drifted), kMotion), 0.02);
  EXPECT_LT(rotation_error(mapping.to_map(drifted), kMotion), 0.004);
  EXPECT_GT(mapping.points().size(), 500U);
}

TEST(LoamScanToMap, CorrectsTheOdometryInARoom) { expect_corrected(Config().mapping); }

TEST(LoamScanToMap, ALoamCorrectsTheOdometryInARoom) { expect_corrected(a_loam().mapping); }

/// Scans of a LiDAR that moves steadily, one in 100 ms.
std::vector<Delivery> deliveries_in(const test::CorridorShape& shape, int scans) {
  std::vector<Delivery> deliveries;
  Pose T_world_lidar = kStart;
  for (int i = 0; i < scans; ++i) {
    auto scan = std::make_shared<LidarScan>(scan_in(shape, T_world_lidar, kMotion));
    scan->stamp += i * 100 * kMillisecond;
    scan->end += i * 100 * kMillisecond;
    T_world_lidar = T_world_lidar * kMotion;
    deliveries.push_back({scan->end, LidarScanPtr(scan)});
  }
  return deliveries;
}

EstimatorResult run(const Config& config, const SensorRig& rig, int scans) {
  Loam loam(config, rig);
  for (const Delivery& delivery : deliveries_in(kRoom, scans)) loam.consume(delivery);
  loam.finish();
  return loam.result();
}

TEST(Loam, ReportsThePoseOfTheBody) {
  SensorRig rig;
  rig.T_body_lidar = pose_of({0.2, 0.0, 0.1}, {0.0, 0.1, 0.5});
  const EstimatorResult in_lidar_axes = run(a_loam(), SensorRig(), 3);
  const EstimatorResult result = run(a_loam(), rig, 3);
  ASSERT_EQ(result.trajectory.size(), 3U);
  for (std::size_t i = 0; i < 3; ++i) {
    const Pose expected =
        rig.T_body_lidar * in_lidar_axes.trajectory[i].pose * rig.T_body_lidar.inverse();
    EXPECT_LT(position_error(result.trajectory[i].pose, expected), 1e-12);
    EXPECT_LT(rotation_error(result.trajectory[i].pose, expected), 1e-7);
  }
  EXPECT_LT(position_error(result.trajectory[0].pose, Pose()), 1e-12);
}

TEST(Loam, FollowsASteadyMotionInARoom) {
  const EstimatorResult result = run(Config(), SensorRig(), 8);
  ASSERT_EQ(result.trajectory.size(), 8U);
  Pose truth;
  for (int i = 1; i < 8; ++i) truth = truth * kMotion;
  EXPECT_LT(position_error(result.trajectory.back().pose, truth), 0.3 * truth.translation.norm());
}

TEST(Loam, ReportsItsOwnDegeneracy) {
  const EstimatorResult result = run(Config(), SensorRig(), 3);
  const Diagnostics& diagnostics = result.diagnostics;
  ASSERT_EQ(diagnostics.scans.size(), 3U);
  EXPECT_FALSE(diagnostics.updated(0));
  EXPECT_TRUE(diagnostics.updated(1));
  EXPECT_GT(diagnostics.value(1, "odometry_smallest_eigenvalue"), 10.0);
  EXPECT_EQ(diagnostics.value(1, "odometry_removed_directions"), 0.0);
  EXPECT_GT(diagnostics.value(2, "mapping_smallest_eigenvalue"), 100.0);
  EXPECT_TRUE(std::isnan(diagnostics.value(1, "mapping_matches")));
}

TEST(Loam, EmptyScansLeaveThePoseFinite) {
  Loam loam(Config{}, SensorRig{});
  for (const Delivery& delivery : deliveries_in(kRoom, 3)) loam.consume(delivery);
  auto empty = std::make_shared<LidarScan>();
  empty->stamp = 3 * 100 * kMillisecond;
  empty->end = empty->stamp + 100 * kMillisecond;
  loam.consume({empty->end, LidarScanPtr(empty)});
  loam.finish();
  ASSERT_EQ(loam.result().trajectory.size(), 4U);
  EXPECT_TRUE(loam.result().trajectory.back().pose.translation.allFinite());
}

}  // namespace
}  // namespace aims::loam
