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

/// The five points of `map` nearest to `query` within `gate`, as squared distances, by a kd-tree.
std::vector<float> nearest_by_tree(const Tree& tree, const Eigen::Vector3f& query, double gate) {
  std::array<std::uint32_t, 5> indices{};
  std::array<float, 5> squared{};
  const std::size_t count = tree.knnSearch(query.data(), 5, indices.data(), squared.data());
  std::vector<float> found(squared.begin(), squared.begin() + static_cast<std::ptrdiff_t>(count));
  std::erase_if(found, [gate](float each) { return each > static_cast<float>(gate * gate); });
  return found;
}

// Half a map has the points of every second insertion, as a map of its own would have them.
TEST(VoxelMap, NearestEqualsTheKdTreeOfEachHalfWithinTheGate) {
  MapConfig config;
  config.point_spacing = 0.05;
  VoxelMap map(config);
  const std::array<Points, 2> inserted{random_points(3, 20000, 5.0), random_points(8, 15000, 5.0)};
  for (const Points& points : inserted) map.insert(points, Eigen::Vector3f::Zero());
  int compared = 0;
  for (std::size_t half = 0; half < 2; ++half) {
    VoxelMap alone(config);
    alone.insert(inserted[half], Eigen::Vector3f::Zero());
    const Cloud cloud{alone.points()};
    Tree tree(3, cloud);
    tree.buildIndex();
    for (const Eigen::Vector3f& query : random_points(4, 2000, 6.0)) {
      std::array<Neighbors, 2> found;
      map.nearest(query, found);
      const std::vector<float> expected = nearest_by_tree(tree, query, config.voxel_size);
      ASSERT_EQ(found[half].count, static_cast<int>(expected.size()));
      for (std::size_t i = 0; i < expected.size(); ++i, ++compared) {
        const float squared = (found[half].points[i] - query).squaredNorm();
        ASSERT_NEAR(squared, expected[i], 1e-6F);
      }
    }
  }
  EXPECT_GT(compared, 10000);
}

/// Points of the plane z = `height` around the origin.
Points level_points(double height, std::uint64_t seed) {
  Points points = random_points(seed, 400, 0.6);
  for (Eigen::Vector3f& p : points) p.z() = static_cast<float>(height);
  return points;
}

/// Half of the map into which each of `count` insertions goes, by a return at a place of its own.
std::vector<int> halves_of_insertions(int count) {
  VoxelMap map(MapConfig{});
  std::vector<int> halves;
  for (int i = 0; i < count; ++i) {
    const Eigen::Vector3f place(2.0F * static_cast<float>(i), 0.0F, 0.0F);
    map.insert(Points{place}, place);
    std::array<Neighbors, kHalves> found;
    map.nearest(place, found);
    halves.push_back(found[1].count);
  }
  return halves;
}

// Scans of one stride share the error of the pose, so blocks of 2 s alternate; at the start short
// ones, so that both halves soon have planes.
TEST(VoxelMap, BlocksOfScansAlternateBetweenTheHalves) {
  const std::vector<int> halves = halves_of_insertions(200);
  std::vector<int> lengths{1};
  for (std::size_t i = 1; i < halves.size(); ++i) {
    if (halves[i] == halves[i - 1]) {
      ++lengths.back();
    } else {
      lengths.push_back(1);
    }
  }
  const std::vector<int> expected{1, 1, 2, 2, 4, 4, 8, 8, 16, 16, 20, 20, 20, 20, 20};
  ASSERT_GE(lengths.size(), expected.size());
  lengths.resize(expected.size());
  EXPECT_EQ(lengths, expected);
}

TEST(VoxelMap, TheSecondScanIsInTheOtherHalf) {
  VoxelMap map(MapConfig{});
  const Eigen::Vector3f query(0.05F, 0.05F, 0.2F);
  map.insert(level_points(0.1, 1), Eigen::Vector3f::Zero());
  EXPECT_FALSE(map.planes_at(query).valid()) << "one half is empty";
  map.insert(level_points(0.3, 2), Eigen::Vector3f::Zero());
  map.insert(level_points(0.1, 3), Eigen::Vector3f::Zero());
  const PlanePair planes = map.planes_at(query);
  ASSERT_TRUE(planes.valid());
  EXPECT_NEAR(planes.a.point.z(), 0.1, 1e-6);
  EXPECT_NEAR(planes.b.point.z(), 0.3, 1e-6);
  EXPECT_NEAR(std::abs(planes.a.normal.z()), 1.0, 1e-6);
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

// A wall along the border of voxels, with returns on either side of it by their noise: one layer of
// points on the wall. With voxels that know nothing of each other there were two, 2 cm apart.
TEST(VoxelMap, AWallAlongABorderOfVoxelsIsOneLayer) {
  RandomStream random(6, "voxel_map_test");
  for (const double wall : {0.49, 0.5, 0.505}) {
    VoxelMap map(MapConfig{});
    for (int scan = 0; scan < 80; ++scan) {
      Points points;
      for (int i = 0; i < 200; ++i) {
        const Eigen::Vector3d p(random.uniform(0.0, 2.0), wall + 0.01 * random.normal(),
                                random.uniform(0.0, 1.0));
        points.push_back(p.cast<float>());
      }
      map.insert(points, Eigen::Vector3f::Zero());
    }
    double sum = 0.0;
    double largest = 0.0;
    const Points points = map.points();
    for (const Eigen::Vector3f& p : points) {
      sum += p.y();
      largest = std::max(largest, std::abs(p.y() - wall));
    }
    EXPECT_NEAR(sum / static_cast<double>(points.size()), wall, 0.0015) << wall;
    EXPECT_LT(largest, 0.015) << wall;
    EXPECT_LT(points.size(), 2U * 120U) << "per half: 2 m^2 at a spacing of 15 cm";
  }
}

TEST(VoxelMap, PointsPerVoxelAreBounded) {
  MapConfig config;
  config.point_spacing = 0.0;
  VoxelMap map(config);
  map.insert(random_points(6, 20000, 0.9), Eigen::Vector3f::Zero());
  map.insert(random_points(7, 20000, 0.9), Eigen::Vector3f::Zero());
  EXPECT_LE(map.points().size(), 2 * 32 * map.voxel_count()) << "per half";
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
    std::array<Neighbors, 2> neighbors;
    map.nearest(points.back(), neighbors);
    ASSERT_GT(neighbors[0].count + neighbors[1].count, 0);
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
  Eigen::Vector3f end(5.0F * 5999.0F, 0.0F, 0.0F);
  for (std::uint64_t i = 0; i < 60; ++i) {  // three blocks of scans at the speed of a robot
    end.x() += 0.1F;
    map.insert(corridor_around(end, i), end);
  }
  int found = 0;
  for (const Eigen::Vector3f& p : corridor_around(end, 7)) found += map.planes_at(p).valid();
  EXPECT_GT(found, 100);
}

TEST(VoxelMap, IgnoresNonFinitePoints) {
  VoxelMap map(MapConfig{});
  const float nan = std::numeric_limits<float>::quiet_NaN();
  map.insert(Points{{nan, 0.0F, 0.0F}, {0.0F, INFINITY, 0.0F}}, Eigen::Vector3f::Zero());
  EXPECT_TRUE(map.empty());
}

}  // namespace
}  // namespace aims
