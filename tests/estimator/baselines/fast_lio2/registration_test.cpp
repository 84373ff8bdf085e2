// SPDX-License-Identifier: BSD-3-Clause
#include "estimator/baselines/fast_lio2/registration.hpp"

#include <gtest/gtest.h>

#include "tests/estimator/baselines/fast_lio2/random_states.hpp"

namespace aims::fast_lio2 {
namespace {

constexpr unsigned kSeed = 13;

Neighbours neighbours_of(const std::array<Eigen::Vector3f, kNeighbours>& points) {
  Neighbours neighbours;
  neighbours.count = kNeighbours;
  neighbours.points = points;
  return neighbours;
}

/// Five points of the plane n . p = d.
Neighbours on_plane(const Eigen::Vector3f& normal, float d, std::mt19937& random) {
  Neighbours neighbours;
  neighbours.count = kNeighbours;
  for (Eigen::Vector3f& point : neighbours.points) {
    const Eigen::Vector3f any = test::random_vector(random, 0.5).cast<float>();
    point = any + (d - normal.dot(any)) * normal;
  }
  return neighbours;
}

TEST(FastLio2Plane, IsThatOfItsPoints) {
  std::mt19937 random(kSeed);
  for (int i = 0; i < 50; ++i) {
    const Eigen::Vector3f normal = test::random_vector(random, 1.0).normalized().cast<float>();
    const auto plane = fit_plane(on_plane(normal, 2.0F, random), 0.1);
    ASSERT_TRUE(plane.has_value()) << "seed " << kSeed << ", case " << i;
    EXPECT_NEAR(std::abs(plane->normal.dot(normal)), 1.0F, 1e-4F);
    EXPECT_NEAR(plane->distance(2.0F * normal), 0.0F, 1e-3F);
    EXPECT_NEAR(std::abs(plane->distance(2.3F * normal)), 0.3F, 1e-3F);
  }
}

TEST(FastLio2Plane, IsRefusedWhenANeighbourIsFarFromIt) {
  const std::array<Eigen::Vector3f, kNeighbours> bent = {
      Eigen::Vector3f(0, 0, 1), Eigen::Vector3f(1, 0, 1), Eigen::Vector3f(0, 1, 1),
      Eigen::Vector3f(1, 1, 1), Eigen::Vector3f(0.5F, 0.5F, 1.6F)};
  EXPECT_FALSE(fit_plane(neighbours_of(bent), 0.1).has_value());
  EXPECT_TRUE(fit_plane(neighbours_of(bent), 1.0).has_value());
}

TEST(FastLio2Plane, ThroughOnePointIsRefused) {
  std::array<Eigen::Vector3f, kNeighbours> zero;
  zero.fill(Eigen::Vector3f::Zero());
  EXPECT_FALSE(fit_plane(neighbours_of(zero), 0.1).has_value());
}

TEST(FastLio2PointResidual, JacobianMatchesFiniteDifferences) {
  std::mt19937 random(kSeed);
  for (int i = 0; i < 10; ++i) {
    const State x = test::random_state(random);
    const Eigen::Vector3f point = test::random_vector(random, 3.0).cast<float>();
    const Eigen::Vector3d normal = test::random_vector(random, 1.0).normalized();
    const FittedPlane plane{normal.cast<float>(), 0.7F};
    const auto row = point_residual(x, point, plane, true);
    const auto known_mount = point_residual(x, point, plane, false);
    EXPECT_NEAR(row.distance, normal.dot(to_world(x, point)) + 0.7, 1e-5);
    for (int k = 0; k < Error::kMeasured; ++k) {
      // The distance itself is in single precision.
      constexpr double kStep = 1e-6;
      const ErrorVector step = kStep * ErrorVector::Unit(k);
      const double slope = plane.normal.cast<double>().dot(to_world(plus(x, step), point) -
                                                           to_world(plus(x, -step), point)) /
                           (2.0 * kStep);
      EXPECT_NEAR(row.jacobian(k), slope, 1e-6) << "seed " << kSeed << ", entry " << k;
      const bool of_mount = k >= Error::kMountRotation;
      EXPECT_EQ(known_mount.jacobian(k), of_mount ? 0.0 : row.jacobian(k));
    }
  }
}

/// A floor with a point every 10 cm.
PointMap floor_map() {
  PointMap map(0.05);
  for (int x = -30; x <= 30; ++x) {
    for (int y = -30; y <= 30; ++y) {
      map.add({0.1F * static_cast<float>(x), 0.1F * static_cast<float>(y), -1.0F});
    }
  }
  return map;
}

TEST(FastLio2Registration, AcceptsAResidualByTheRangeOfItsPoint) {
  const PointMap map = floor_map();
  // At 1 m range the limit is (1 - 0.9) / 0.9 sqrt(1 m) = 0.11 m.
  const std::vector<Eigen::Vector3f> points = {
      {0.0F, 0.0F, -1.0F}, {0.0F, 0.0F, -0.95F}, {0.0F, 0.0F, -0.8F}, {2.0F, 2.0F, -0.9F}};
  Registration registration(points, map, Residuals(), false);
  const ScanResiduals& found = registration.evaluate(State(), true);
  ASSERT_EQ(found.distances.size(), 3);
  EXPECT_NEAR(std::abs(found.distances(1)), 0.05, 1e-5);
  EXPECT_NEAR(std::abs(found.distances(2)), 0.1, 1e-5);
}

TEST(FastLio2Registration, LeavesOutPointsFarFromTheMap) {
  const PointMap map = floor_map();
  const std::vector<Eigen::Vector3f> points = {{2.0F, 2.0F, -1.0F}, {9.0F, 0.0F, -1.0F}};
  Registration registration(points, map, Residuals(), false);
  EXPECT_EQ(registration.evaluate(State(), true).distances.size(), 1);
}

TEST(FastLio2Registration, APointLeftOutReturnsOnlyWithANewSearch) {
  const PointMap map = floor_map();
  const std::vector<Eigen::Vector3f> points = {{0.0F, 0.0F, -1.0F}};
  Registration registration(points, map, Residuals(), false);
  State above;
  above.T_world_body.translation.z() = 0.3;
  EXPECT_EQ(registration.evaluate(State(), true).distances.size(), 1);
  EXPECT_EQ(registration.evaluate(above, false).distances.size(), 0);
  EXPECT_EQ(registration.evaluate(State(), false).distances.size(), 0);
  EXPECT_EQ(registration.evaluate(State(), true).distances.size(), 1);
}

}  // namespace
}  // namespace aims::fast_lio2
