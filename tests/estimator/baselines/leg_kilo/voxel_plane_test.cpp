// SPDX-License-Identifier: BSD-3-Clause
#include "estimator/baselines/leg_kilo/voxel_plane.hpp"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <vector>

#include "tests/estimator/baselines/leg_kilo/random_states.hpp"

namespace aims::leg_kilo {
namespace {

constexpr unsigned kSeed = 11;
constexpr double kMaxEigenvalue = 0.01;

/// Points near a tilted plane, each with a covariance of its own.
std::vector<MapPoint> points_near_plane(std::mt19937& random, int count) {
  const Eigen::Quaterniond tilt = so3_exp({0.4, -0.3, 0.2});
  std::vector<MapPoint> points;
  for (int i = 0; i < count; ++i) {
    Eigen::Vector3d local = test::random_vector(random, 0.15);
    local.x() *= 2.0;
    local.z() *= 0.1;
    const Eigen::Matrix3d root = Eigen::Matrix3d::NullaryExpr(
        [&] { return 0.002 * std::normal_distribution<double>()(random); });
    points.push_back({tilt * local + Eigen::Vector3d(3.0, -2.0, 1.0), root * root.transpose()});
  }
  return points;
}

/// The plane's normal and centre after `point` has moved by `step`; the normal on the side of
/// `normal`.
Eigen::Matrix<double, 6, 1> moved(std::vector<MapPoint> points, std::size_t point,
                                  const Eigen::Vector3d& step, const Eigen::Vector3d& normal) {
  points[point].position += step;
  const std::optional<VoxelPlane> plane = fit_plane(points, kMaxEigenvalue);
  Eigen::Matrix<double, 6, 1> values;
  values << (plane->normal.dot(normal) < 0.0 ? -1.0 : 1.0) * plane->normal, plane->centre;
  return values;
}

TEST(LegKiloPlane, CovarianceFollowsFromFiniteDifferencesInEachPoint) {
  constexpr double kStep = 1e-6;
  std::mt19937 random(kSeed);
  const std::vector<MapPoint> points = points_near_plane(random, 12);
  const std::optional<VoxelPlane> plane = fit_plane(points, kMaxEigenvalue);
  ASSERT_TRUE(plane);
  Eigen::Matrix<double, 6, 6> expected = Eigen::Matrix<double, 6, 6>::Zero();
  for (std::size_t i = 0; i < points.size(); ++i) {
    Eigen::Matrix<double, 6, 3> J;
    for (int k = 0; k < 3; ++k) {
      const Eigen::Vector3d step = kStep * Eigen::Vector3d::Unit(k);
      J.col(k) = (moved(points, i, step, plane->normal) - moved(points, i, -step, plane->normal)) /
                 (2.0 * kStep);
    }
    expected += J * points[i].covariance * J.transpose();
  }
  EXPECT_LT((plane->covariance - expected).norm(), 1e-6 * expected.norm()) << "seed " << kSeed;
}

TEST(LegKiloPlane, VarianceOfADistanceIsThatOfManyDraws) {
  constexpr int kDraws = 4000;
  std::mt19937 random(kSeed);
  std::normal_distribution<double> normal;
  const std::vector<MapPoint> points = points_near_plane(random, 12);
  const std::optional<VoxelPlane> plane = fit_plane(points, kMaxEigenvalue);
  ASSERT_TRUE(plane);
  const Eigen::Vector3d query = plane->centre + Eigen::Vector3d(0.3, 0.2, -0.1);
  double sum = 0.0;
  for (int draw = 0; draw < kDraws; ++draw) {
    std::vector<MapPoint> drawn = points;
    for (MapPoint& each : drawn) {
      const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> root(each.covariance);
      const Eigen::Vector3d unit(normal(random), normal(random), normal(random));
      each.position += root.operatorSqrt() * unit;
    }
    const std::optional<VoxelPlane> other = fit_plane(drawn, kMaxEigenvalue);
    const double side = other->normal.dot(plane->normal) < 0.0 ? -1.0 : 1.0;
    const double change = side * other->distance(query) - plane->distance(query);
    sum += change * change / kDraws;
  }
  EXPECT_NEAR(plane->distance_variance(query), sum, 0.1 * sum) << "seed " << kSeed;
}

TEST(LegKiloPlane, RadiusAndCentreAreThoseOfThePoints) {
  std::vector<MapPoint> points;
  for (const double x : {-0.2, 0.0, 0.2}) {
    for (const double y : {-0.1, 0.1}) points.push_back({{x, y, 1.0}, Eigen::Matrix3d::Identity()});
  }
  const std::optional<VoxelPlane> plane = fit_plane(points, kMaxEigenvalue);
  ASSERT_TRUE(plane);
  EXPECT_NEAR(std::abs(plane->normal.z()), 1.0, 1e-12);
  EXPECT_LT((plane->centre - Eigen::Vector3d(0.0, 0.0, 1.0)).norm(), 1e-12);
  EXPECT_NEAR(plane->radius, std::sqrt(0.08 / 3.0), 1e-12);
}

TEST(LegKiloPlane, ThickPointsAndOneRepeatedPointHaveNoPlane) {
  std::vector<MapPoint> thick;
  for (int i = 0; i < 8; ++i) {
    thick.push_back({{0.3 * (i & 1), 0.4 * (i / 2 & 1), 0.5 * (i / 4)}, Eigen::Matrix3d::Zero()});
  }
  EXPECT_FALSE(fit_plane(thick, kMaxEigenvalue));
  EXPECT_TRUE(fit_plane(thick, 0.03));
  EXPECT_FALSE(fit_plane(std::vector<MapPoint>(8), kMaxEigenvalue));
}

}  // namespace
}  // namespace aims::leg_kilo
