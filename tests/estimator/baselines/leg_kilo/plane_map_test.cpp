// SPDX-License-Identifier: BSD-3-Clause
#include "estimator/baselines/leg_kilo/plane_map.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "tests/estimator/baselines/leg_kilo/random_states.hpp"

namespace aims::leg_kilo {
namespace {

constexpr unsigned kSeed = 13;

MapPoint point_at(const Eigen::Vector3d& position) {
  return {position, 1e-4 * Eigen::Matrix3d::Identity()};
}

/// Points on floor and walls of a room of 4 m, and some in the air.
std::vector<MapPoint> points_in_room(std::mt19937& random, int count) {
  std::uniform_real_distribution<double> along(-2.0, 2.0);
  std::vector<MapPoint> points;
  for (int i = 0; i < count; ++i) {
    Eigen::Vector3d position(along(random), along(random), along(random));
    if (i % 5 != 0) position(i % 3) = -2.0 + 0.013 * (i % 3);
    points.push_back(point_at(position + test::random_vector(random, 0.01)));
  }
  return points;
}

/// Centres of planes, sorted.
using Centres = std::vector<std::array<float, 3>>;

Centres sorted(const std::vector<Eigen::Vector3f>& points) {
  Centres centres;
  for (const Eigen::Vector3f& each : points) centres.push_back({each.x(), each.y(), each.z()});
  std::ranges::sort(centres);
  return centres;
}

/// The planes of points in a cube by definition: one of all, else those of its eighths.
void planes_by_definition(const std::vector<MapPoint>& points, const Eigen::Vector3d& corner,
                          double edge, int layers, std::vector<Eigen::Vector3f>& centres) {
  if (points.size() <= 5) return;
  if (const auto plane = fit_plane(points, 0.01)) {
    centres.push_back(plane->centre.cast<float>());
    return;
  }
  if (layers == 0) return;
  for (int eighth = 0; eighth < 8; ++eighth) {
    const Eigen::Vector3d from =
        corner + 0.5 * edge * Eigen::Vector3d(eighth & 1, eighth >> 1 & 1, eighth >> 2);
    std::vector<MapPoint> inside;
    std::ranges::copy_if(points, std::back_inserter(inside), [&](const MapPoint& each) {
      const Eigen::Array3d at = each.position.array();
      return (at > from.array()).all() && (at <= from.array() + 0.5 * edge).all();
    });
    planes_by_definition(inside, from, 0.5 * edge, layers - 1, centres);
  }
}

TEST(LegKiloMap, TheFirstScansPlanesAreThoseByDefinition) {
  std::mt19937 random(kSeed);
  const std::vector<MapPoint> points = points_in_room(random, 6000);
  PlaneMap map{Map()};
  map.build(points);
  std::map<std::array<int, 3>, std::vector<MapPoint>> cubes;
  for (const MapPoint& each : points) {
    const Eigen::Array3i at = (each.position.array() / 0.5).floor().cast<int>();
    cubes[{at.x(), at.y(), at.z()}].push_back(each);
  }
  std::vector<Eigen::Vector3f> expected;
  for (const auto& [at, inside] : cubes) {
    planes_by_definition(inside, 0.5 * Eigen::Vector3d(at[0], at[1], at[2]), 0.5, 2, expected);
  }
  ASSERT_GT(expected.size(), 100U);
  const Centres found = sorted(map.plane_centres());
  const Centres wanted = sorted(expected);
  ASSERT_EQ(found.size(), wanted.size()) << "seed " << kSeed;
  for (std::size_t i = 0; i < found.size(); ++i) {
    for (std::size_t k = 0; k < 3; ++k) EXPECT_NEAR(found[i][k], wanted[i][k], 1e-5);
  }
}

/// The only plane of a tree.
std::optional<VoxelPlane> plane_of(const PlaneTree& tree) { return tree.plane(); }

TEST(LegKiloMap, APlaneIsRenewedWithEverySixthPointUntilItIsFinal) {
  std::mt19937 random(kSeed);
  std::uniform_real_distribution<double> along(0.0, 0.5);
  const Map config;
  PlaneTree tree(Eigen::Vector3d::Constant(0.25), 0.5);
  std::vector<MapPoint> points;
  std::optional<VoxelPlane> last;
  for (int count = 1; count <= 80; ++count) {
    points.push_back(point_at({along(random), along(random), 0.2 + 0.01 * along(random)}));
    tree.add(points.back(), config);
    const std::optional<VoxelPlane> plane = plane_of(tree);
    EXPECT_EQ(plane.has_value(), count >= 6);
    if (count >= 6 && count % 6 == 0 && count <= 50) {
      EXPECT_LT((plane->centre - fit_plane(points, 0.01)->centre).norm(), 1e-12) << count;
    } else if (count > 6) {
      EXPECT_EQ(plane->centre, last->centre) << count;
    }
    last = plane;
  }
}

TEST(LegKiloMap, AVoxelWithTwoSurfacesIsDivided) {
  PlaneMap map{Map()};
  std::vector<MapPoint> points;
  for (int i = 0; i < 50; ++i) {
    const double along = 0.02 + 0.05 * (i % 10);
    points.push_back(point_at({along, 0.05 + 0.1 * (i / 10), 0.05}));
    points.push_back(point_at({along, 0.05 + 0.1 * (i / 10), 0.45}));
  }
  map.build(points);
  for (const Eigen::Vector3f& each : map.plane_centres()) {
    EXPECT_NEAR(std::abs(each.z() - 0.25F), 0.2F, 1e-6);
  }
  EXPECT_GE(map.plane_centres().size(), 4U);
}

/// A point with a beam's deviation of 1 cm at a state without error.
ScanPoint query_at(const Eigen::Vector3d& position) {
  const Eigen::Matrix3d covariance = 1e-4 * Eigen::Matrix3d::Identity();
  return {position, position, covariance, covariance};
}

/// A map of one horizontal plane in the voxel whose lowest corner is `corner`.
PlaneMap map_with_plane(const Eigen::Vector3d& corner, double height) {
  std::vector<MapPoint> points;
  for (int i = 0; i < 25; ++i) {
    points.push_back(
        point_at(corner + Eigen::Vector3d(0.05 + 0.1 * (i % 5), 0.05 + 0.1 * (i / 5), height)));
  }
  PlaneMap map{Map()};
  map.build(points);
  return map;
}

TEST(LegKiloMap, APointLiesOnAPlaneWithinThreeDeviationsAndThreeRadii) {
  const PlaneMap map = map_with_plane(Eigen::Vector3d::Zero(), 0.2);
  const Residuals config;
  const auto match = map.match(query_at({0.25, 0.25, 0.22}), config);
  ASSERT_TRUE(match);
  EXPECT_NEAR(std::abs(match->distance), 0.02, 1e-9);
  EXPECT_GT(match->distance * match->normal.z(), 0.0);
  EXPECT_GT(match->variance, 1e-4);
  EXPECT_LT(match->variance, 2e-4);
  EXPECT_FALSE(map.match(query_at({0.25, 0.25, 0.26}), config));
  EXPECT_TRUE(map.match(query_at({0.25, 0.25, 0.26}), {.gate = 10.0}));
  EXPECT_TRUE(map.match(query_at({0.49, 0.49, 0.2}), config));
  EXPECT_FALSE(map.match(query_at({0.49, 0.49, 0.2}), {.max_extent = 1.0}));
  EXPECT_FALSE(map.match(query_at({0.25, 0.25, 0.7}), config));  // no voxel there
}

TEST(LegKiloMap, OfTwoPlanesTheMoreProbableIsMatched) {
  Map coarse;
  coarse.layers = 1;
  PlaneMap map(coarse);
  std::vector<MapPoint> points;
  for (int i = 0; i < 100; ++i) {
    const Eigen::Vector3d at(0.02 + 0.045 * (i % 10), 0.02 + 0.045 * (i / 10), 0.0);
    points.push_back(point_at(at + Eigen::Vector3d(0.0, 0.0, 0.05)));
    points.push_back(point_at(at + Eigen::Vector3d(0.0, 0.0, 0.45)));
  }
  map.build(points);
  const Residuals wide{.gate = 100.0, .max_extent = 10.0};
  EXPECT_NEAR(std::abs(map.match(query_at({0.2, 0.2, 0.15}), wide)->distance), 0.1, 1e-6);
  EXPECT_NEAR(std::abs(map.match(query_at({0.2, 0.2, 0.35}), wide)->distance), 0.1, 1e-6);
}

// The published search compares voxels with metres: the neighbour is the one away from the origin.
TEST(LegKiloMap, WithoutAPlaneTheVoxelFurtherFromTheOriginIsSearched) {
  for (const double side : {1.0, -1.0}) {
    const Eigen::Vector3d here = Eigen::Vector3d::Constant(side > 0.0 ? 2.0 : -2.5);
    const Eigen::Vector3d further = here + 0.5 * side * Eigen::Vector3d::Ones();
    PlaneMap map = map_with_plane(further, side > 0.0 ? 0.01 : 0.49);
    const Eigen::Vector3d query = here + Eigen::Vector3d(0.25, 0.25, side > 0.0 ? 0.5 : 0.0);
    const Residuals wide{.max_extent = 100.0};
    const Eigen::Vector3d inside = query - Eigen::Vector3d(0.0, 0.0, 0.001 * side);
    EXPECT_FALSE(map.match(query_at(inside), wide));  // its voxel is not in the map
    map.add(std::vector<MapPoint>{point_at(here + Eigen::Vector3d::Constant(0.2))});
    EXPECT_TRUE(map.match(query_at(inside), wide));
  }
}

TEST(LegKiloMap, FarVoxelsAreDroppedWhenThereAreTooMany) {
  Map config;
  config.min_points = 3;
  PlaneMap map(config);
  const auto add_plane = [&map](double x) {
    std::vector<MapPoint> points;
    for (int i = 0; i < 4; ++i) points.push_back(point_at({x + 0.1 * (i & 1), 0.1 * (i / 2), 0.1}));
    map.add(points);
  };
  add_plane(0.1);
  std::vector<MapPoint> rest;
  for (int i = 0; i < 201000; ++i) {
    rest.push_back(point_at({0.5 * (i % 450) + 1.1, 0.5 * (i / 450) + 1.1, 0.1}));
  }
  map.add(rest);
  map.limit({300.0, 300.0, 0.0});
  EXPECT_TRUE(map.plane_centres().empty());
}

}  // namespace
}  // namespace aims::leg_kilo
