// SPDX-License-Identifier: BSD-3-Clause
#include "estimator/lidar/voxel_map.hpp"

#include <gtest/gtest.h>

#include <nanoflann.hpp>

#include "core/random.hpp"

namespace aims {
namespace {

using Points = std::vector<Eigen::Vector3f>;

Points random_points(std::uint64_t seed, int count, double extent) {
  RandomStream random(seed, "voxel_map_test");
  Points points;
  for (int i = 0; i < count; ++i) {
    points.emplace_back(Eigen::Vector3d(random.uniform(-extent, extent),
                                        random.uniform(-extent, extent), random.uniform(-1.0, 1.0))
                            .cast<float>());
  }
  return points;
}

struct Cloud {
  Points points;
  std::size_t kdtree_get_point_count() const { return points.size(); }
  float kdtree_get_pt(std::size_t i, std::size_t axis) const {
    return points[i](static_cast<Eigen::Index>(axis));
  }
  template <class Box>
  bool kdtree_get_bbox(Box&) const {
    return false;
  }
};

using Tree =
    nanoflann::KDTreeSingleIndexAdaptor<nanoflann::L2_Simple_Adaptor<float, Cloud>, Cloud, 3>;

TEST(VoxelMap, NearestEqualsTheKdTreeWithinTheGate) {
  MapConfig config;
  config.point_spacing = 0.05;
  VoxelMap map(config);
  map.insert(random_points(3, 40000, 5.0), Eigen::Vector3f::Zero());
  const Cloud cloud{map.points()};
  Tree tree(3, cloud);
  tree.buildIndex();
  int compared = 0;
  for (const Eigen::Vector3f& query : random_points(4, 2000, 6.0)) {
    Neighbors found;
    map.nearest(query, found);
    std::array<std::uint32_t, 5> indices{};
    std::array<float, 5> squared{};
    tree.knnSearch(query.data(), 5, indices.data(), squared.data());
    const auto gate = static_cast<float>(config.neighbor_gate * config.neighbor_gate);
    int expected = 0;
    while (expected < 5 && squared[expected] <= gate) ++expected;
    ASSERT_EQ(found.count, expected);
    for (int i = 0; i < expected; ++i, ++compared) {
      ASSERT_NEAR(found.squared_distances[i], squared[i], 1e-6F);
    }
  }
  EXPECT_GT(compared, 5000);
}

TEST(VoxelMap, MergesNearbyReturns) {
  MapConfig config;
  VoxelMap map(config);
  RandomStream random(5, "merge");
  Points points;
  for (int i = 0; i < 20; ++i) {
    points.emplace_back(0.25F, 0.25F, 0.25F + 0.02F * static_cast<float>(random.normal()));
  }
  map.insert(points, Eigen::Vector3f::Zero());
  ASSERT_EQ(map.points().size(), 1U);
  EXPECT_NEAR(map.points()[0].z(), 0.25F, 0.015F);
}

TEST(VoxelMap, PointsPerVoxelAreBounded) {
  MapConfig config;
  config.point_spacing = 0.0;
  config.max_points_per_voxel = 10;
  VoxelMap map(config);
  map.insert(random_points(6, 20000, 0.9), Eigen::Vector3f::Zero());
  EXPECT_LE(map.points().size(), 10 * map.voxel_count());
}

TEST(VoxelMap, DropsTheFarthestVoxelsWhenFull) {
  MapConfig config;
  config.max_voxels = 1000;
  VoxelMap map(config);
  for (int i = 0; i < 40; ++i) {
    const Eigen::Vector3f center(static_cast<float>(5 * i), 0.0F, 0.0F);
    Points points = random_points(static_cast<std::uint64_t>(i), 2000, 3.0);
    for (Eigen::Vector3f& p : points) p += center;
    map.insert(points, center);
    ASSERT_LE(map.voxel_count(), 1000U);
    Neighbors neighbors;
    map.nearest(points.back(), neighbors);
    ASSERT_GT(neighbors.count, 0);
  }
}

/// Returns of a corridor along x, 10 m to both sides of `center`.
Points corridor_around(const Eigen::Vector3f& center, std::uint64_t seed) {
  Points points = random_points(seed, 500, 1.1);
  for (Eigen::Vector3f& p : points) {
    p = center + Eigen::Vector3f(9.0F * p.x(), p.y() > 0.0F ? 1.1F : -1.1F, p.z());
  }
  return points;
}

// Thirty kilometres: neither the voxels nor their memory grow once the map is full, and
// planes are found around the robot.
TEST(VoxelMap, MemoryIsBoundedOverManyKilometres) {
  MapConfig config;
  config.max_voxels = 3000;
  VoxelMap map(config);
  std::size_t memory = 0;
  for (int i = 0; i < 6000; ++i) {
    const Eigen::Vector3f center(5.0F * static_cast<float>(i), 0.0F, 0.0F);
    map.insert(corridor_around(center, static_cast<std::uint64_t>(i)), center);
    ASSERT_LE(map.voxel_count(), 3000U);
    if (i == 1000) memory = map.memory();
    if (i > 1000) {
      ASSERT_EQ(map.memory(), memory) << "at " << center.x() << " m";
    }
  }
  const Eigen::Vector3f end(5.0F * 5999.0F, 0.0F, 0.0F);
  int found = 0;
  for (const Eigen::Vector3f& p : corridor_around(end, 7)) found += map.plane_at(p).valid;
  EXPECT_GT(found, 100);
}

TEST(VoxelMap, DropsVoxelsUnseenForLong) {
  VoxelMap map(MapConfig{});
  const Eigen::Vector3f here(0.25F, 0.25F, 0.25F);
  const Eigen::Vector3f there(20.25F, 0.25F, 0.25F);
  map.insert(Points{here, there}, here);
  for (int i = 0; i < 9; ++i) map.insert(Points{here}, here);
  map.forget_unseen(10);
  EXPECT_EQ(map.voxel_count(), 2U);
  map.insert(Points{here}, here);
  map.forget_unseen(10);
  ASSERT_EQ(map.voxel_count(), 1U);
  Neighbors neighbors;
  map.nearest(here, neighbors);
  EXPECT_EQ(neighbors.count, 1);
  map.nearest(there, neighbors);
  EXPECT_EQ(neighbors.count, 0);
}

TEST(VoxelMap, IgnoresNonFinitePoints) {
  VoxelMap map(MapConfig{});
  const float nan = std::numeric_limits<float>::quiet_NaN();
  map.insert(Points{{nan, 0.0F, 0.0F}, {0.0F, INFINITY, 0.0F}}, Eigen::Vector3f::Zero());
  EXPECT_TRUE(map.empty());
}

}  // namespace
}  // namespace aims
