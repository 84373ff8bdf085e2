// SPDX-License-Identifier: BSD-3-Clause
#include "estimator/baselines/fast_lio2/point_map.hpp"

#include <gtest/gtest.h>

namespace aims::fast_lio2 {
namespace {

constexpr double kVoxel = 1.0;

/// Five equal neighbours.
Neighbours at(const Eigen::Vector3f& point) {
  Neighbours neighbours;
  neighbours.count = kNeighbours;
  neighbours.points.fill(point);
  return neighbours;
}

TEST(FastLio2Insertion, ANeighbourNearerToTheCentreKeepsThePointOut) {
  const PointMap map(kVoxel);
  const Eigen::Vector3f point(0.5F, 0.5F, 0.2F);
  EXPECT_EQ(insertion_of(point, at({0.5F, 0.5F, 0.6F}), map, kVoxel), Insertion::kNone);
  EXPECT_EQ(insertion_of(point, at({0.5F, 0.5F, 0.1F}), map, kVoxel), Insertion::kVoxel);
  // Outside the voxel along one axis only.
  EXPECT_EQ(insertion_of(point, at({0.5F, 0.5F, 1.6F}), map, kVoxel), Insertion::kVoxel);
}

TEST(FastLio2Insertion, APointWhoseNearestIsOutsideAlongEveryAxisGoesInUnchecked) {
  const PointMap map(kVoxel);
  EXPECT_EQ(insertion_of({0.5F, 0.5F, 0.5F}, at({1.1F, -0.1F, 1.1F}), map, kVoxel),
            Insertion::kUnchecked);
}

TEST(FastLio2Insertion, FewNeighboursLeaveTheVoxelToDecide) {
  const PointMap map(kVoxel);
  Neighbours one = at({0.5F, 0.5F, 0.5F});
  one.count = 1;
  EXPECT_EQ(insertion_of({0.5F, 0.5F, 0.2F}, one, map, kVoxel), Insertion::kVoxel);
  EXPECT_EQ(insertion_of({0.5F, 0.5F, 0.2F}, Neighbours(), map, kVoxel), Insertion::kVoxel);
}

TEST(FastLio2LocalCube, MovesAheadOfTheLidarAndForgetsWhatIsBehind) {
  // Edge 100 m, margin 15 m: a move of 0.45 (100 - 30) = 31.5 m.
  const Map config{.cube = 100.0, .detection_range = 10.0, .moving_factor = 1.5};
  PointMap map(kVoxel);
  for (const float x : {-45.0F, -20.0F, -10.0F, 45.0F}) map.add({x, 0.0F, 0.0F});
  LocalCube cube(config);
  cube.follow({0.0, 0.0, 0.0}, map);
  cube.follow({34.0, 0.0, 0.0}, map);
  EXPECT_EQ(map.size(), 4U);
  cube.follow({36.0, 0.0, 0.0}, map);  // the cube was [-50, 50], is [-18.5, 81.5]
  EXPECT_EQ(map.size(), 2U);
  cube.follow({66.0, 0.0, 0.0}, map);
  EXPECT_EQ(map.size(), 2U);
  cube.follow({67.0, 0.0, 0.0}, map);  // [13, 113]
  EXPECT_EQ(map.size(), 1U);
}

}  // namespace
}  // namespace aims::fast_lio2
