// SPDX-License-Identifier: BSD-3-Clause
// Where features find their lines and planes: the last scan, and the map.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "core/random.hpp"
#include "estimator/baselines/features/feature_map.hpp"
#include "estimator/baselines/features/feature_matches.hpp"

namespace aims::features {
namespace {

constexpr int kSeed = 5;

FeatureCloud random_rings(int rings, int per_ring) {
  RandomStream random(kSeed, "rings");
  FeatureCloud cloud;
  for (int ring = 0; ring < rings; ++ring) {
    for (int i = 0; i < per_ring; ++i) {
      cloud.push_back({(2.0 * random.normal3()).cast<float>(), 0.0F, ring});
    }
  }
  return cloud;
}

/// The nearest feature for which `allowed` is true, by looking at all; nullptr: none.
template <class Allowed>
const FeaturePoint* nearest_of(const FeatureCloud& cloud, const Eigen::Vector3f& point,
                               Allowed allowed) {
  const FeaturePoint* best = nullptr;
  for (const FeaturePoint& each : cloud) {
    if (!allowed(each)) continue;
    if (best == nullptr || (each.position - point).norm() < (best->position - point).norm()) {
      best = &each;
    }
  }
  return best;
}

TEST(PointIndex, NeighboursEqualThoseOfBruteForce) {
  const FeatureCloud cloud = random_rings(1, 500);
  PointIndex index;
  index.build(positions_of(cloud));
  RandomStream random(kSeed, "queries");
  for (int i = 0; i < 50; ++i) {
    const Eigen::Vector3f query = random.normal3().cast<float>();
    std::vector<float> expected;
    for (const FeaturePoint& each : cloud) {
      expected.push_back((each.position - query).squaredNorm());
    }
    std::ranges::sort(expected);
    std::array<Neighbor, 5> found;
    ASSERT_EQ(index.nearest(query, found), 5U);
    for (std::size_t k = 0; k < 5; ++k) {
      EXPECT_FLOAT_EQ(found[k].squared_distance, expected[k]) << "seed " << kSeed;
    }
  }
}

TEST(PointIndex, FewerPointsGiveFewerNeighbours) {
  PointIndex index;
  std::array<Neighbor, 5> found;
  EXPECT_EQ(index.nearest(Eigen::Vector3f::Zero(), found), 0U);
  index.build({Eigen::Vector3f::Ones(), Eigen::Vector3f::Zero()});
  ASSERT_EQ(index.nearest(Eigen::Vector3f::Zero(), found), 2U);
  EXPECT_EQ(found[0].index, 1);
}

TEST(RingReference, LinesAndPlanesPassThroughTheNearestOfTheirRings) {
  const FeatureCloud cloud = random_rings(8, 30);
  const RingMatchConfig config;
  RingReference reference;
  reference.set(cloud);
  RandomStream random(kSeed, "queries");
  for (int i = 0; i < 50; ++i) {
    const Eigen::Vector3f query = random.normal3().cast<float>();
    const FeaturePoint* a = nearest_of(cloud, query, [](const FeaturePoint&) { return true; });
    const FeaturePoint* b = nearest_of(
        cloud, query, [&](const FeaturePoint& each) { return each.ring == a->ring && &each != a; });
    const FeaturePoint* c = nearest_of(cloud, query, [&](const FeaturePoint& each) {
      return each.ring != a->ring && std::abs(each.ring - a->ring) <= config.ring_reach;
    });
    const auto line = reference.line_near(query, 1, config);
    const auto plane = reference.plane_near(query, 1, config);
    ASSERT_TRUE(line && plane) << "seed " << kSeed;
    const auto off_line = [&](const FeaturePoint* point) {
      return line->direction.cross(point->position.cast<double>() - line->origin).norm();
    };
    EXPECT_LT(off_line(a) + off_line(c), 1e-6) << "seed " << kSeed;
    for (const FeaturePoint* point : {a, b, c}) {
      const double off = plane->normal.dot(point->position.cast<double>()) + plane->offset;
      EXPECT_NEAR(off, 0.0, 1e-6) << "seed " << kSeed;
    }
  }
}

TEST(RingReference, FartherFeaturesAreNoMatches) {
  RingReference reference;
  reference.set(random_rings(4, 10));
  EXPECT_FALSE(reference.line_near({40.0F, 0.0F, 0.0F}, 1, RingMatchConfig()));
  EXPECT_FALSE(reference.plane_near({40.0F, 0.0F, 0.0F}, 1, RingMatchConfig()));
  reference.set({});
  EXPECT_FALSE(reference.line_near(Eigen::Vector3f::Zero(), 1, RingMatchConfig()));
}

TEST(RingReference, OneRingHasNeitherLinesNorPlanes) {
  RingReference reference;
  reference.set(random_rings(1, 50));
  EXPECT_FALSE(reference.line_near(Eigen::Vector3f::Zero(), 1, RingMatchConfig()));
  EXPECT_FALSE(reference.plane_near(Eigen::Vector3f::Zero(), 1, RingMatchConfig()));
}

TEST(RingReference, ATruncatedSearchEndsWithTheNearestFeature) {
  const FeatureCloud cloud = random_rings(8, 30);
  RingMatchConfig config;
  config.truncated_search = true;
  RingReference reference;
  reference.set(cloud);
  const FeaturePoint& lowest = cloud.front();
  EXPECT_FALSE(reference.line_near(lowest.position, 1, config)) << "seed " << kSeed;
  EXPECT_TRUE(reference.line_near(lowest.position, cloud.size(), config));
  EXPECT_TRUE(reference.line_near(cloud.back().position, 1, config));
}

TEST(MapFits, ALineNeedsOneLongAxis) {
  const Eigen::Vector3d direction = Eigen::Vector3d(1, -2, 3).normalized();
  FitPoints points;
  for (int i = 0; i < kFitNeighbors; ++i) {
    points[i] = Eigen::Vector3d(1.0, 2.0, 3.0) + 0.1 * i * direction;
  }
  const auto line = fit_line(points, 3.0);
  ASSERT_TRUE(line);
  EXPECT_NEAR(std::abs(line->direction.dot(direction)), 1.0, 1e-9);
  points = {Eigen::Vector3d(0, 0, 0), Eigen::Vector3d(1, 0, 0), Eigen::Vector3d(0, 1, 0),
            Eigen::Vector3d(1, 1, 0), Eigen::Vector3d(0.5, 0.5, 0)};
  EXPECT_FALSE(fit_line(points, 3.0));
}

TEST(MapFits, APlaneHoldsWithinItsTolerance) {
  const Eigen::Vector3d normal = Eigen::Vector3d(1, 1, 4).normalized();
  FitPoints points = {Eigen::Vector3d(0, 0, 2), Eigen::Vector3d(1, 0, 2), Eigen::Vector3d(0, 1, 2),
                      Eigen::Vector3d(1, 1, 2), Eigen::Vector3d(0.4, 0.6, 2)};
  for (Eigen::Vector3d& point : points) point += (2.0 - normal.dot(point)) * normal;
  const auto plane = fit_plane_by_intercepts(points, 0.2);
  ASSERT_TRUE(plane);
  for (const Eigen::Vector3d& point : points) {
    EXPECT_NEAR(plane->normal.dot(point) + plane->offset, 0.0, 1e-9);
  }
  points[4] += 0.5 * normal;
  EXPECT_FALSE(fit_plane_by_intercepts(points, 0.2));
}

TEST(CubeMap, AnAverageWeighsAsMuchAsANewPoint) {
  CubeMap map(50.0, 0.4);
  map.insert({{{0.1F, 0.1F, 0.1F}}, {{0.3F, 0.1F, 0.1F}}});
  map.insert({{{0.3F, 0.1F, 0.1F}}});
  ASSERT_EQ(map.points().size(), 1U);
  EXPECT_FLOAT_EQ(map.points()[0].x(), 0.25F);
}

TEST(CubeMap, HasThePointsOfTheCubesInReach) {
  CubeMap map(50.0, 0.4);
  map.insert({{{0.0F, 0.0F, 0.0F}}, {{120.0F, 0.0F, 0.0F}}, {{130.0F, 0.0F, 0.0F}}});
  EXPECT_EQ(map.around(Eigen::Vector3d::Zero()).size(), 2U);
  EXPECT_EQ(map.around({30.0, 0.0, 0.0}).size(), 3U);
  EXPECT_EQ(map.points().size(), 3U);
}

}  // namespace
}  // namespace aims::features
