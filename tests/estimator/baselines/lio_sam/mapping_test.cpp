// SPDX-License-Identifier: BSD-3-Clause
#include "estimator/baselines/lio_sam/mapping.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/estimator/baselines/room_scan.hpp"

namespace aims::lio_sam {
namespace {

using aims::testing::open_corridor;
using aims::testing::pose_of;
using aims::testing::position_error;
using aims::testing::room;
using aims::testing::rotation_error;
using aims::testing::scan_in;

const test::CorridorShape kRoom = room(12.0, 9.0, 4.0);
const Pose kStart{Eigen::Quaterniond::Identity(), {0.3, -0.4, 1.6}};
const Pose kMotion = pose_of({0.12, 0.03, 0.01}, {0.004, -0.003, 0.02});

ScanFeatures features_at(const test::CorridorShape& shape, const Pose& T_world_lidar,
                         std::uint64_t seed) {
  const LidarScan scan = scan_in(shape, T_world_lidar, Pose(), {.noise = 0.01, .seed = seed});
  FeatureConfig config;
  config.edge_curvature = 0.1;
  config.surface_voxel = 0.2;
  return scan_features(deskewed_rings(scan, GyroRotation({}, 0), {}), config);
}

ScanPrior level() {
  ScanPrior prior;
  prior.imu_available = true;
  return prior;
}

/// With the voxels for indoors.
MappingConfig fine() {
  MappingConfig config;
  config.edge_voxel = 0.1;
  config.surface_voxel = 0.2;
  return config;
}

TEST(LioSamMapping, RegistersAScanInARoom) {
  Mapping mapping{fine()};
  const RegisteredScan first = mapping.update(0, features_at(kRoom, kStart, 1), level());
  EXPECT_TRUE(first.keyframe);
  EXPECT_LT(position_error(first.T_map_lidar, Pose()), 1e-9);
  ScanPrior prior;  // without IMU
  const RegisteredScan second =
      mapping.update(kSecond, features_at(kRoom, kStart * kMotion, 2), prior);
  EXPECT_LT(position_error(second.T_map_lidar, kMotion), 0.04) << "seeds 1, 2";
  EXPECT_LT(rotation_error(second.T_map_lidar, kMotion), 0.005);
  EXPECT_FALSE(second.degenerate);
  EXPECT_FALSE(second.keyframe);
}

TEST(LioSamMapping, StartsWithTheImusAttitude) {
  Mapping mapping{fine()};
  ScanPrior prior = level();
  prior.attitude = {0.1, -0.05, 0.4};
  const RegisteredScan first = mapping.update(0, features_at(kRoom, kStart, 1), prior);
  EXPECT_LT(rotation_error(first.T_map_lidar, {rotation_of(prior.attitude), {}}), 1e-9);
}

/// Along an open corridor nothing is seen: the guess stays.
TEST(LioSamMapping, InACorridorTheGuessDecidesAndTheScanIsDegenerate) {
  const Pose start{Eigen::Quaterniond::Identity(), {0.0, 0.1, 0.6}};
  const auto scan_at = [&](double x, std::uint64_t seed) {
    return features_at(open_corridor(), pose_of({x, 0.0, 0.0}, {0.0, 0.0, 0.0}) * start, seed);
  };
  MappingConfig config;
  config.min_scan_edges = 0;
  config.matching.min_map_edges = 0;
  config.matching.plane_tolerance = 0.1;
  Mapping mapping{config};
  ScanPrior prior = level();
  prior.odometry = Pose();
  ScanFeatures first = scan_at(0.0, 1);
  first.edges.assign(3, {{1.0F, 1.0F, 1.0F}});
  (void)mapping.update(0, first, prior);
  ScanFeatures second = scan_at(0.3, 2);
  second.edges = first.edges;
  (void)mapping.update(kSecond, second, prior);  // the odometry is known from here on
  const double before = mapping.update(2 * kSecond, second, prior).T_map_lidar.translation.x();
  prior.odometry = pose_of({0.25, 0.0, 0.0}, {0.0, 0.0, 0.0});
  const RegisteredScan last = mapping.update(3 * kSecond, second, prior);
  EXPECT_TRUE(last.degenerate);
  EXPECT_GE(last.solver.directions.removed, 1);
  EXPECT_NEAR(last.T_map_lidar.translation.x() - before, 0.25, 0.01) << "seeds 1, 2";
}

TEST(LioSamMapping, RegistersScansAtTheInterval) {
  Mapping mapping{fine()};
  std::vector<int> registered;
  const ScanFeatures scan = features_at(kRoom, kStart, 1);
  for (int i = 0; i < 6; ++i) {
    const Time stamp = i * 100 * kMillisecond;
    if (!mapping.is_due(stamp)) continue;
    registered.push_back(i);
    (void)mapping.update(stamp, scan, level());
  }
  EXPECT_EQ(registered, (std::vector<int>{0, 2, 4}));
}

TEST(LioSamMapping, AScanWithFewFeaturesKeepsTheGuess) {
  Mapping mapping{fine()};
  (void)mapping.update(0, features_at(kRoom, kStart, 1), level());
  ScanPrior prior = level();
  prior.attitude.yaw = 0.3;
  const RegisteredScan blind = mapping.update(kSecond, ScanFeatures(), prior);
  EXPECT_EQ(blind.solver.iterations, 0);
  EXPECT_FALSE(blind.rejected);
  EXPECT_NEAR(angles_of(blind.T_map_lidar.rotation).yaw, 0.3, 1e-9);
}

TEST(LioSamMapping, AGuessThatIsNoNumberIsRejected) {
  Mapping mapping{fine()};
  (void)mapping.update(0, features_at(kRoom, kStart, 1), level());
  ScanPrior prior = level();
  prior.odometry = Pose();
  (void)mapping.update(kSecond, features_at(kRoom, kStart, 2), prior);
  for (const double bad : {std::nan(""), 1e9}) {
    prior.odometry->translation.x() = bad;
    const RegisteredScan result = mapping.update(2 * kSecond, features_at(kRoom, kStart, 2), prior);
    EXPECT_TRUE(result.rejected);
    EXPECT_LT(result.T_map_lidar.translation.norm(), 0.1);
    EXPECT_TRUE(result.odometry.T_map_lidar.translation.allFinite());
  }
  EXPECT_EQ(mapping.map().size(), 1);
}

TEST(LioSamMapping, KeepsAKeyframeAfterADistanceOrAnAngle) {
  Mapping mapping{fine()};
  (void)mapping.update(0, features_at(kRoom, kStart, 1), level());
  const auto kept = [&](const Pose& motion, int second) {
    return mapping.update(second * kSecond, features_at(kRoom, kStart * motion, 2), ScanPrior())
        .keyframe;
  };
  EXPECT_FALSE(kept(pose_of({0.4, 0.0, 0.0}, {0.0, 0.0, 0.1}), 1));
  EXPECT_FALSE(kept(pose_of({0.8, 0.0, 0.0}, {0.0, 0.0, 0.0}), 2));
  EXPECT_TRUE(kept(pose_of({1.1, 0.0, 0.0}, {0.0, 0.0, 0.0}), 3));
  EXPECT_FALSE(kept(pose_of({1.1, 0.0, 0.0}, {0.0, 0.0, 0.15}), 4));
  EXPECT_TRUE(kept(pose_of({1.1, 0.0, 0.0}, {0.0, 0.0, 0.25}), 5));
}

}  // namespace
}  // namespace aims::lio_sam
