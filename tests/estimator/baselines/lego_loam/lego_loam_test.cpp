// SPDX-License-Identifier: BSD-3-Clause
#include "estimator/baselines/lego_loam/lego_loam.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>
#include <vector>

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

/// Small variances, a firm start: the program's graph has a solution, and a loop turns the route.
TEST(LegoPoseGraph, ALoopTurnsARouteWhoseHeadingDrifts) {
  constexpr int kLast = 200;
  pose_graph::PoseGraph graph(graph_config());
  const Pose step = pose_of({0.3, 0.0, 0.0}, {0.0, 0.0, 2.0 * std::numbers::pi / kLast});
  const Pose drift = pose_of({0.0, 0.0, 0.0}, {0.0, 0.0, 4e-4});
  std::vector<Pose> truth = {Pose()};
  Pose believed;
  graph.add(believed, {});
  for (int i = 1; i <= kLast; ++i) {
    truth.push_back(truth.back() * step);
    believed = believed * step * drift;
    graph.add(believed, {});
  }
  ASSERT_GT(position_error(graph.pose(kLast), truth[kLast]), 0.4);
  const pose_graph::Loop loop{kLast, 0, truth[kLast].inverse() * truth[0], 1e-7};
  EXPECT_TRUE(graph.add(believed * step, {loop}));
  EXPECT_LT(position_error(graph.pose(kLast), truth[kLast]), 0.02);
  EXPECT_LT(position_error(graph.pose(kLast / 2), truth[kLast / 2]), 0.1);
  EXPECT_LT(position_error(graph.pose(0), Pose()), 1e-6);
}

/// A map without registration: poses are those of the odometry, but for loops.
MappingConfig loops_alone() {
  MappingConfig config;
  config.every_nth = 1;
  config.matching.min_map_edges = 1000000;
  config.graph.rotation_variance = 0.1;
  config.graph.position_variance = config.graph.height_variance = 1.0;
  config.loop.enabled = true;
  config.loop.min_age = 6.5;
  config.loop.keyframes = 1;
  return config;
}

/// Where the map sees the LiDAR, against the truth [m]: it goes around in a room and one step more,
/// its odometry slips by 4 cm and 0.3 degrees a step.
struct TourErrors {
  double before = 0.0;  ///< back at the start
  double after = 0.0;   ///< one step later
  double worst_keyframe = 0.0;
  int loops = 0;
};

TourErrors drive(const MappingConfig& config) {
  Mapping mapping(config);
  TourErrors errors;
  Pose odometry;
  std::vector<Pose> truth;
  for (int i = 0; i < 9; ++i) {
    const double angle = 0.25 * std::numbers::pi * i;
    truth.push_back(
        pose_of({std::sin(angle), 1.0 - std::cos(angle), 0.0}, {0.0, 0.0, 0.1 * angle}));
    if (i > 0) {
      odometry = odometry * truth[i - 1].inverse() * truth[i] *
                 pose_of({0.03, 0.02, 0.01}, {0.0, 0.0, 0.005});
    }
    mapping.update(i * kSecond, odometry,
                   features_of(noisy_scan(kStart * truth.back(), Pose(), 10 + i)));
    (i < 8 ? errors.before : errors.after) = position_error(mapping.to_map(odometry), truth.back());
  }
  for (int i = 0; i < mapping.map().size(); ++i) {
    errors.worst_keyframe =
        std::max(errors.worst_keyframe, position_error(mapping.map()[i].T_map_lidar, truth[i]));
  }
  errors.loops = mapping.loops();
  return errors;
}

TEST(LegoMapping, ALoopRemovesTheDriftOfPoseAndKeyframes) {
  const TourErrors errors = drive(loops_alone());
  EXPECT_EQ(errors.loops, 2) << "at the last two keyframes, of which the first joins the graph";
  EXPECT_GT(errors.before, 0.25);
  EXPECT_LT(errors.after, 0.1) << "as far as points on sparse rings can be aligned; seeds 10 to 18";
  EXPECT_LT(errors.worst_keyframe, 0.1);
}

TEST(LegoMapping, KeyframesTooYoungOrTooFarCloseNoLoop) {
  MappingConfig young = loops_alone();
  young.loop.min_age = 9.0;
  MappingConfig far = loops_alone();
  far.loop.radius = 0.1;
  MappingConfig off = loops_alone();
  off.loop.enabled = false;
  for (const MappingConfig& config : {young, far, off}) {
    const TourErrors errors = drive(config);
    EXPECT_EQ(errors.loops, 0);
    EXPECT_GT(errors.after, 0.25) << "the drift stays";
  }
}

/// Returns to a place after two keyframes far away.
TEST(LegoMapping, WithLoopsTheLastKeyframesMakeTheMap) {
  const SegmentedFeatures scan = features_of(noisy_scan(kStart, Pose(), 1));
  const auto matches = [&](bool loops, int keyframes) {
    MappingConfig config;
    config.every_nth = 1;
    config.loop.enabled = loops;
    config.submap_keyframes = keyframes;
    Mapping mapping(config);
    int stamp = 0;
    std::optional<features::SolverResult> last;
    for (const double x : {0.0, 22.0, 45.0, 0.0}) {
      last = mapping.update(stamp++ * kSecond, pose_of({x, 0.0, 0.0}, {0.0, 0.0, 0.0}), scan);
    }
    return last->lines + last->planes;
  };
  EXPECT_GT(matches(false, 2), 50);
  EXPECT_GT(matches(true, 3), 50);
  EXPECT_EQ(matches(true, 2), 0);
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
