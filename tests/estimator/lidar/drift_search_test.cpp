// SPDX-License-Identifier: BSD-3-Clause
#include "estimator/lidar/drift_search.hpp"

#include <gtest/gtest.h>

#include <optional>
#include <vector>

#include "core/random.hpp"

namespace aims {
namespace {

constexpr double kNoise = 0.01;  // of a return [m]
const Eigen::Vector3d kAlong = Eigen::Vector3d::UnitX();

/// A return on a wall across the x axis at `x`, 2 m wide and high.
Eigen::Vector3d on_wall(double x, RandomStream& random) {
  return Eigen::Vector3d(x, 2.0 * random.uniform() - 1.0, 2.0 * random.uniform() - 1.0) +
         kNoise * random.normal3();
}

/// A map of such walls.
VoxelMap map_of_walls(std::initializer_list<double> walls, RandomStream& random) {
  VoxelMap map(MapConfig{});
  for (std::size_t half = 0; half < kHalves; ++half) {
    std::vector<Eigen::Vector3f> points;
    for (const double x : walls) {
      for (int i = 0; i < 2000; ++i) points.push_back(on_wall(x, random).cast<float>());
    }
    map.insert(points, Eigen::Vector3f::Zero());
  }
  return map;
}

/// The offset that `count` returns on the wall at 20 m ask for, from a pose that is `drift` too
/// far.
std::optional<double> offset_after_drift(double drift, int count, double reach,
                                         std::initializer_list<double> walls = {20.0}) {
  RandomStream random(1, "relocalization");
  const VoxelMap map = map_of_walls(walls, random);
  std::vector<Eigen::Vector3d> returns;
  for (int i = 0; i < count; ++i) returns.push_back(on_wall(20.0, random));
  const Pose drifted{Eigen::Quaterniond::Identity(), drift * kAlong};
  return offset_by_consensus(returns, drifted, kAlong, reach, map);
}

TEST(DriftSearch, FindsTheWallWhereverTheDriftPutsIt) {
  for (const double drift : {-1.9, -0.73, -0.35, 0.28, 0.5, 1.2}) {
    const std::optional<double> offset = offset_after_drift(drift, 20, 2.0);
    ASSERT_TRUE(offset) << drift << " m";
    EXPECT_NEAR(*offset, -drift, 0.01) << drift << " m";
  }
}

TEST(DriftSearch, SearchesNoFartherThanItsReach) {
  EXPECT_FALSE(offset_after_drift(0.9, 20, 0.5));
  EXPECT_FALSE(offset_after_drift(0.6, 20, 0.5)) << "though a plane is in reach from there";
}

TEST(DriftSearch, FewReturnsAreNoConsensus) {
  EXPECT_FALSE(offset_after_drift(0.4, kMinConsensus - 1, 1.0));
  EXPECT_TRUE(offset_after_drift(0.4, 2 * kMinConsensus, 1.0));
}

TEST(DriftSearch, OfTwoWallsTheNearerOneCounts) {
  const std::optional<double> offset = offset_after_drift(0.4, 20, 2.0, {20.0, 21.0});
  ASSERT_TRUE(offset);
  EXPECT_NEAR(*offset, -0.4, 0.01);
}

TEST(DriftSearch, WallsAlongTheAxisAreNone) {
  RandomStream random(1, "relocalization.along");
  const VoxelMap map = map_of_walls({20.0}, random);
  std::vector<Eigen::Vector3d> returns;
  for (int i = 0; i < 50; ++i) returns.push_back(on_wall(20.0, random));
  const Pose drifted{Eigen::Quaterniond::Identity(), 0.4 * kAlong};
  EXPECT_FALSE(offset_by_consensus(returns, drifted, Eigen::Vector3d::UnitY(), 1.0, map));
}

}  // namespace
}  // namespace aims
