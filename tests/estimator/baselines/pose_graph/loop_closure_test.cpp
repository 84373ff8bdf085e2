// SPDX-License-Identifier: BSD-3-Clause
#include "estimator/baselines/pose_graph/loop_closure.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/random.hpp"
#include "tests/estimator/baselines/room_scan.hpp"

namespace aims::pose_graph {
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

TEST(Icp, FindsTheMotionOfACloud) {
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

TEST(Icp, FitnessIsTheMeanSquaredDistance) {
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

/// Where the last keyframe believes that it is.
void search(LoopClosure& loops, double seconds, const features::KeyframeMap& map) {
  loops.search(from_seconds(seconds), map.last_pose().translation, map);
}

const Pose kError = pose_of({0.15, -0.1, 0.05}, {0.01, 0.02, -0.02});

TEST(LoopClosure, MeasuresTheNewestKeyframeFromAnOldOne) {
  LoopClosure loops(config());
  search(loops, 40.0, round_trip(kError));
  const std::vector<Loop> found = loops.take_found();
  ASSERT_EQ(found.size(), 1U);
  EXPECT_EQ(found[0].newer, 2);
  EXPECT_EQ(found[0].older, 0) << "the nearest that is older than 30 s";
  const Pose expected = pose_of({1.2, 1.0, 1.0}, {0.0, 0.0, 0.05}).inverse() *
                        pose_of({1.0, 1.0, 1.0}, {0.0, 0.0, 0.0});
  EXPECT_LT(position_error(found[0].T_newer_older, expected), 0.01);
  EXPECT_LT(rotation_error(found[0].T_newer_older, expected), 0.01);
  EXPECT_TRUE(loops.take_found().empty());
  search(loops, 42.0, round_trip(kError));
  EXPECT_EQ(loops.closed(), 1) << "one loop per keyframe";
}

TEST(LoopClosure, LeavesOutYoungFarAndPoorMatches) {
  LoopConfig young = config();
  young.min_age = 41.0;
  LoopConfig far = config();
  far.radius = 0.1;
  LoopConfig poor = config();
  poor.max_fitness = 1e-9;
  LoopConfig off = config();
  off.enabled = false;
  LoopConfig small_newer = config();
  small_newer.min_newer_points = 100000;
  LoopConfig small_older = config();
  small_older.min_older_points = 100000;
  for (const LoopConfig& each : {young, far, poor, off, small_newer, small_older}) {
    LoopClosure loops(each);
    search(loops, 40.0, round_trip(kError));
    EXPECT_EQ(loops.closed(), 0);
  }
}

TEST(LoopClosure, SearchesAroundThePositionThatItIsGiven) {
  const features::KeyframeMap map = round_trip(kError);
  LoopClosure loops(config());
  loops.search(from_seconds(60.0), map[1].T_map_lidar.translation, map);
  const std::vector<Loop> found = loops.take_found();
  ASSERT_EQ(found.size(), 1U);
  EXPECT_EQ(found[0].newer, 2);
  EXPECT_EQ(found[0].older, 1);
}

// Outliers at the true place would pull the older cloud away from the error's measurement.
TEST(LoopClosure, OutliersAreNotAligned) {
  features::KeyframeMap map = round_trip(kError);
  features::Keyframe noisy = map[0];
  noisy.outliers = noisy.planes;
  noisy.planes.clear();
  features::KeyframeMap with_outliers;
  with_outliers.add(noisy);
  with_outliers.add(map[2]);
  LoopConfig each = config();
  each.keyframes = 0;
  LoopClosure loops(each);
  search(loops, 40.0, with_outliers);
  EXPECT_EQ(loops.closed(), 0) << "nothing else is left to align with";
}

/// Ten keyframes around the corner's room and back at the first after 30 s. Each one but the first
/// believes that it has moved by `drift` more than it has.
struct Tour {
  std::vector<Pose> truth;
  std::vector<Pose> believed;
};

Tour drifting_tour(const Pose& drift) {
  Tour tour;
  for (int i = 0; i < 10; ++i) {
    const double angle = 2.0 * std::numbers::pi * i / 9.0;
    tour.truth.push_back(
        pose_of({2.0 + std::cos(angle), 1.5 + std::sin(angle), 1.0}, {0.0, 0.0, 0.0}));
    if (i == 0) tour.believed.push_back(tour.truth[0]);
    if (i == 0) continue;
    const Pose step = tour.truth[i - 1].inverse() * tour.truth[i];
    tour.believed.push_back(tour.believed.back() * step * drift);
  }
  return tour;
}

struct Driven {
  features::KeyframeMap map;
  int loops = 0;
};

double worst_error(const features::KeyframeMap& map, const Tour& tour) {
  double worst = 0.0;
  for (int i = 0; i < map.size(); ++i) {
    worst = std::max(worst, position_error(map[i].T_map_lidar, tour.truth[i]));
  }
  return worst;
}

/// Drives the tour, then adds one more keyframe where the last one is.
Driven driven(const Tour& tour, const LoopConfig& loop) {
  PoseGraphConfig graph;
  graph.rotation_variance = 1e-4;
  graph.position_variance = graph.height_variance = 0.1;
  KeyframeGraph keyframes(graph, loop);
  for (int i = 0; i < 10; ++i) {
    features::Keyframe next = keyframe(tour.truth[i], 3.4 * i);
    next.T_map_lidar = tour.believed[i];
    keyframes.add(next);
    keyframes.search(next.stamp, next.T_map_lidar.translation);
  }
  features::Keyframe last = keyframe(tour.truth[9], 40.0);
  last.T_map_lidar = keyframes.map().last_pose();
  keyframes.add(last);
  return {keyframes.map(), keyframes.loops()};
}

TEST(KeyframeGraph, ALoopRemovesTheDriftOfAllKeyframes) {
  const Tour tour = drifting_tour(pose_of({0.03, 0.01, 0.02}, {0.0, 0.0, 0.001}));
  LoopConfig off = config();
  off.enabled = false;
  const Driven drifted = driven(tour, off);
  const Driven closed = driven(tour, config());
  EXPECT_EQ(drifted.loops, 0);
  EXPECT_EQ(closed.loops, 1);
  Tour with_last = tour;
  with_last.truth.push_back(tour.truth[9]);
  EXPECT_GT(worst_error(drifted.map, with_last), 0.15);
  EXPECT_LT(worst_error(closed.map, with_last), 0.04);
  EXPECT_LT(position_error(closed.map.last_pose(), tour.truth[9]), 0.01);
}

TEST(KeyframeGraph, WithoutAGraphAKeyframeStaysToTheLastBit) {
  KeyframeGraph keyframes({}, config());
  const Pose odd = pose_of({0.1, 1.0 / 3.0, 0.7}, {0.1, 0.2, 0.3});
  keyframes.add_fixed(keyframe(Pose(), 0.0));
  keyframes.add_fixed(keyframe(odd, 1.0));
  EXPECT_EQ(keyframes.map()[1].T_map_lidar.translation, odd.translation);
  EXPECT_EQ(keyframes.map()[1].T_map_lidar.rotation.coeffs(), odd.rotation.coeffs());
}

}  // namespace
}  // namespace aims::pose_graph
