// SPDX-License-Identifier: BSD-3-Clause
#include "estimator/baselines/features/ring_features.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/random.hpp"
#include "tests/estimator/baselines/room_scan.hpp"

namespace aims::features {
namespace {

using aims::testing::room;
using aims::testing::scan_in;

constexpr double kLength = 12.0;
constexpr double kWidth = 9.0;
constexpr double kHeight = 4.0;
const Pose kMiddle{Eigen::Quaterniond::Identity(), {0.3, -0.4, 1.5}};

RingFeatures features_of_room() {
  return ring_features(scan_in(room(kLength, kWidth, kHeight), kMiddle), RingFeatureConfig());
}

/// Distances of a point from the three pairs of walls of the room, least first [m].
std::array<double, 3> wall_distances(const FeaturePoint& point) {
  const Eigen::Vector3d p = kMiddle * point.position.cast<double>();
  std::array<double, 3> distances = {kLength / 2.0 - std::abs(p.x()),
                                     kWidth / 2.0 - std::abs(p.y()),
                                     std::min(p.z(), kHeight - p.z())};
  std::ranges::sort(distances);
  return distances;
}

/// A ring of returns in the plane z = 0, `count` of them over 1 rad, at the given ranges.
template <class Range>
FeatureCloud ring_at(int count, Range range) {
  FeatureCloud ring;
  for (int i = 0; i < count; ++i) {
    const double angle = static_cast<double>(i) / count;
    const double r = range(i, angle);
    ring.push_back({Eigen::Vector3d(r * std::cos(angle), r * std::sin(angle), 0.0).cast<float>()});
  }
  return ring;
}

TEST(RingFeatures, SharpPointsLieOnTheEdgesOfARoom) {
  const RingFeatures features = features_of_room();
  ASSERT_GT(features.sharp.size(), 50U);
  for (const FeaturePoint& point : features.sharp) EXPECT_LT(wall_distances(point)[1], 0.1);
}

TEST(RingFeatures, FlatPointsLieOnWallsAwayFromTheirEdges) {
  const RingFeatures features = features_of_room();
  ASSERT_GT(features.flat.size(), 300U);
  for (const FeaturePoint& point : features.flat) {
    EXPECT_LT(wall_distances(point)[0], 1e-4);
    EXPECT_GT(wall_distances(point)[1], 0.02);
  }
}

TEST(RingFeatures, CountsAreBoundedPerSector) {
  const SelectionConfig config;
  const RingFeatures features = features_of_room();
  const std::size_t sectors = 16U * static_cast<std::size_t>(config.sectors);
  EXPECT_LE(features.sharp.size(), sectors * static_cast<std::size_t>(config.max_sharp));
  EXPECT_LE(features.less_sharp.size(), sectors * static_cast<std::size_t>(config.max_less_sharp));
  EXPECT_LE(features.flat.size(), sectors * static_cast<std::size_t>(config.max_flat));
  EXPECT_GE(features.less_sharp.size(), features.sharp.size());
  EXPECT_EQ(features.points, 28800);
}

TEST(RingFeatures, CloudsAreInOrderOfRings) {
  const RingFeatures features = features_of_room();
  for (const FeatureCloud* cloud :
       {&features.sharp, &features.less_sharp, &features.flat, &features.less_flat}) {
    EXPECT_TRUE(std::ranges::is_sorted(*cloud, {}, &FeaturePoint::ring));
  }
}

TEST(RingFeatures, CurvatureIsThatOfTheDefinition) {
  RandomStream random(3, "curvature");
  FeatureCloud ring;
  for (int i = 0; i < 40; ++i) ring.push_back({random.normal3().cast<float>()});
  const std::vector<float> curvature = ring_curvature(ring, 5);
  for (int i = 0; i < 40; ++i) {
    Eigen::Vector3f sum = Eigen::Vector3f::Zero();
    for (int j = i - 5; j <= i + 5 && i >= 5 && i < 35; ++j) {
      sum +=
          ring[static_cast<std::size_t>(j)].position - ring[static_cast<std::size_t>(i)].position;
    }
    EXPECT_NEAR(curvature[static_cast<std::size_t>(i)], sum.squaredNorm(), 1e-2) << "seed 3";
  }
}

TEST(RingFeatures, ReturnsOnTheFarSideOfAnOcclusionAreUnreliable) {
  const FeatureCloud ring = ring_at(100, [](int i, double) { return i < 50 ? 2.0 : 4.0; });
  const std::vector<bool> unreliable = unreliable_points(ring, RingFeatureConfig());
  for (std::size_t i = 0; i < 100; ++i) EXPECT_EQ(unreliable[i], i >= 50 && i <= 55) << i;
}

TEST(RingFeatures, TheFarSideMayComeFirst) {
  const FeatureCloud ring = ring_at(100, [](int i, double) { return i < 50 ? 4.0 : 2.0; });
  const std::vector<bool> unreliable = unreliable_points(ring, RingFeatureConfig());
  for (std::size_t i = 0; i < 100; ++i) EXPECT_EQ(unreliable[i], i >= 44 && i <= 49) << i;
}

TEST(RingFeatures, NearlyParallelSurfacesAreUnreliable) {
  // A wall at y = 0.1: the beam meets it at its own angle, which falls towards the first returns.
  const FeatureCloud ring =
      ring_at(1000, [](int, double angle) { return 0.1 / std::sin(angle + 0.01); });
  const std::vector<bool> unreliable = unreliable_points(ring, RingFeatureConfig());
  EXPECT_TRUE(unreliable[8]);
  for (std::size_t i = 200; i < 990; ++i) EXPECT_FALSE(unreliable[i]) << i;
}

TEST(RingFeatures, ReturnsThatAreNearOrNotFiniteAreDropped) {
  LidarScan scan;
  scan.end = 100;
  const float nan = std::numeric_limits<float>::quiet_NaN();
  scan.points = {{{0.2F, 0.0F, 0.0F}, 0.5F, 0, 0},
                 {{nan, 1.0F, 1.0F}, 0.5F, 0, 0},
                 {{1.0F, 0.0F, 0.0F}, 0.5F, 50, 3},
                 {{1.0F, 0.0F, 0.0F}, 0.5F, 50, 60000}};
  const std::vector<FeatureCloud> rings = ring_clouds(scan, 0.3, 100.0);
  ASSERT_EQ(rings.size(), 4U);
  ASSERT_EQ(rings[3].size(), 1U);
  EXPECT_EQ(rings[0].size(), 0U);
  EXPECT_FLOAT_EQ(rings[3][0].fraction, 0.5F);
}

TEST(RingFeatures, AnEmptyScanHasNone) {
  const RingFeatures features = ring_features(LidarScan(), RingFeatureConfig());
  EXPECT_EQ(features.points, 0);
  EXPECT_TRUE(features.less_flat.empty());
}

TEST(VoxelCentroids, AverageThePointsOfEachVoxel) {
  const FeatureCloud cloud = {
      {{0.1F, 0.1F, 0.1F}, 0.0F, 2}, {{0.3F, 0.1F, 0.1F}, 1.0F, 2}, {{-0.1F, 0.1F, 0.1F}, 0.5F, 2}};
  const FeatureCloud centroids = voxel_centroids(cloud, 0.4);
  ASSERT_EQ(centroids.size(), 2U);
  EXPECT_TRUE(centroids[0].position.isApprox(Eigen::Vector3f(0.2F, 0.1F, 0.1F)));
  EXPECT_FLOAT_EQ(centroids[0].fraction, 0.5F);
  EXPECT_EQ(centroids[1].position, cloud[2].position);
}

}  // namespace
}  // namespace aims::features
