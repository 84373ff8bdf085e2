// SPDX-License-Identifier: BSD-3-Clause
#include "estimator/baselines/fast_lio2/point_map.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <random>

namespace aims::fast_lio2 {
namespace {

constexpr unsigned kSeed = 11;

/// Points on walls, and some anywhere.
std::vector<Eigen::Vector3f> scattered(int count, std::mt19937& random) {
  std::uniform_real_distribution<float> along(-20.0F, 20.0F);
  std::uniform_real_distribution<float> height(-1.0F, 2.0F);
  std::vector<Eigen::Vector3f> points;
  for (int i = 0; i < count; ++i) {
    const float side = i % 2 == 0 ? -1.1F : 1.1F;
    points.emplace_back(along(random), i % 5 == 0 ? along(random) : side, height(random));
  }
  return points;
}

/// The squared distances of the nearest points, by looking at all.
std::vector<float> nearest_by_force(const std::vector<Eigen::Vector3f>& points,
                                    const Eigen::Vector3f& query) {
  std::vector<float> distances;
  for (const Eigen::Vector3f& point : points) distances.push_back((point - query).squaredNorm());
  std::ranges::sort(distances);
  distances.resize(std::min<std::size_t>(distances.size(), kNeighbours));
  return distances;
}

void expect_nearest(const PointMap& map, const Eigen::Vector3f& query) {
  const Neighbours found = map.nearest(query);
  const std::vector<float> expected = nearest_by_force(map.points(), query);
  ASSERT_EQ(static_cast<std::size_t>(found.count), expected.size());
  for (std::size_t i = 0; i < expected.size(); ++i) {
    EXPECT_EQ(found.squared_distances[i], expected[i]) << "seed " << kSeed << ", neighbour " << i;
    EXPECT_EQ((found.points[i] - query).squaredNorm(), found.squared_distances[i]);
  }
}

class FastLio2PointMap : public ::testing::TestWithParam<double> {};

TEST_P(FastLio2PointMap, NeighboursEqualThoseOfBruteForce) {
  std::mt19937 random(kSeed);
  PointMap map(GetParam());
  for (const Eigen::Vector3f& point : scattered(3000, random)) map.add_to_voxel(point);
  for (const Eigen::Vector3f& point : scattered(300, random)) expect_nearest(map, point);
  for (const float far : {30.0F, 90.0F, -400.0F}) {
    expect_nearest(map, {far, 0.3F, 5.0F});
    expect_nearest(map, {1.0F, far, far});
  }
}

TEST_P(FastLio2PointMap, AVoxelKeepsThePointNearestItsCentre) {
  std::mt19937 random(kSeed);
  const auto voxel = static_cast<float>(GetParam());
  PointMap map(GetParam());
  std::map<std::array<int, 3>, Eigen::Vector3f> nearest;
  const std::vector<Eigen::Vector3f> points = scattered(5000, random);
  for (const Eigen::Vector3f& point : points) {
    map.add_to_voxel(point);
    const Eigen::Array3i at = (point.array() / voxel).floor().cast<int>();
    const Eigen::Vector3f centre = (at.cast<float>() * voxel + 0.5F * voxel).matrix();
    Eigen::Vector3f& best = nearest.try_emplace({at.x(), at.y(), at.z()}, point).first->second;
    if ((point - centre).norm() < (best - centre).norm()) best = point;
  }
  EXPECT_EQ(map.size(), nearest.size());
  EXPECT_LT(map.size(), points.size());
  const std::vector<Eigen::Vector3f> kept = map.points();
  for (const auto& [index, best] : nearest) {
    EXPECT_NE(std::ranges::find(kept, best), kept.end()) << "seed " << kSeed;
  }
}

INSTANTIATE_TEST_SUITE_P(Voxels, FastLio2PointMap, ::testing::Values(0.2, 0.5, 1.0));

TEST(FastLio2PointMap, PointsAddedUncheckedLeaveWhenTheirVoxelIsFilledAgain) {
  PointMap map(1.0);
  map.add({0.1F, 0.1F, 0.1F});
  map.add({0.9F, 0.9F, 0.9F});
  EXPECT_EQ(map.size(), 2U);
  map.add_to_voxel({0.05F, 0.05F, 0.05F});  // further from the centre than both
  EXPECT_EQ(map.size(), 1U);
  EXPECT_LT((map.points().front().array() - 0.5F).matrix().norm(), 0.7F);
}

TEST(FastLio2PointMap, OnePointNearerToTheCentreStays) {
  PointMap map(1.0);
  map.add({0.5F, 0.5F, 0.4F});
  map.add_to_voxel({0.1F, 0.5F, 0.5F});
  ASSERT_EQ(map.size(), 1U);
  EXPECT_EQ(map.points().front(), Eigen::Vector3f(0.5F, 0.5F, 0.4F));
  map.add_to_voxel({0.5F, 0.5F, 0.45F});
  ASSERT_EQ(map.size(), 1U);
  EXPECT_EQ(map.points().front(), Eigen::Vector3f(0.5F, 0.5F, 0.45F));
}

TEST(FastLio2PointMap, WhatIsInARemovedBoxIsNoNeighbour) {
  std::mt19937 random(kSeed);
  PointMap map(0.5);
  for (const Eigen::Vector3f& point : scattered(2000, random)) map.add_to_voxel(point);
  const std::size_t before = map.size();
  const Box box{{-5.0F, -30.0F, -30.0F}, {5.0F, 30.0F, 30.0F}};
  map.remove(box);
  EXPECT_LT(map.size(), before);
  EXPECT_EQ(map.points().size(), map.size());
  for (const Eigen::Vector3f& point : map.points()) EXPECT_FALSE(box.contains(point));
  expect_nearest(map, {0.0F, 0.0F, 0.0F});
}

TEST(FastLio2PointMap, AnEmptyMapHasNoNeighbours) {
  PointMap map(0.5);
  EXPECT_EQ(map.nearest({0.0F, 0.0F, 0.0F}).count, 0);
  map.add({1.0F, 1.0F, 1.0F});
  EXPECT_EQ(map.nearest({0.0F, 0.0F, 0.0F}).count, 1);
}

}  // namespace
}  // namespace aims::fast_lio2
