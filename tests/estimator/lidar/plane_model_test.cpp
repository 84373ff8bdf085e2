// SPDX-License-Identifier: BSD-3-Clause
#include "estimator/lidar/plane_model.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "core/random.hpp"
#include "estimator/lidar/lidar_config.hpp"
#include "tests/estimator/finite_differences.hpp"

namespace aims {
namespace {

/// Five points as the map holds them around a query: one in the middle, four at its spacing.
PlanePoints spread_on_plane(const Eigen::Vector3d& normal, double noise, RandomStream& random) {
  const Eigen::Vector3d u = normal.unitOrthogonal();
  const Eigen::Vector3d v = normal.cross(u);
  PlanePoints points;
  std::size_t count = 0;
  const double d = MapConfig{}.point_spacing;
  for (const auto& [a, b] : {std::pair{d, 0.0}, {-d, 0.02}, {0.0, d}, {0.03, -d}, {0, 0}}) {
    const Eigen::Vector3d p =
        Eigen::Vector3d(5.0, 1.0, 2.0) + a * u + b * v + noise * random.normal() * normal;
    points[count++] = p.cast<float>();
  }
  return points;
}

/// The plane of one half at `query`; the other has points of its own, which must not matter.
Plane plane_at(const PlanePoints& points, const Eigen::Vector3f& query) {
  RandomStream random(2, "plane");
  const PlanePoints others = spread_on_plane(random.normal3().normalized(), 0.01, random);
  const Plane plane = fit_planes({points, others}, query).a;
  EXPECT_EQ(fit_planes({others, points}, query).b.valid, plane.valid);
  return plane;
}

/// At their mean.
Plane plane_of(const PlanePoints& points) {
  Eigen::Vector3f sum = Eigen::Vector3f::Zero();
  for (const Eigen::Vector3f& p : points) sum += p;
  return plane_at(points, sum / 5.0F);
}

TEST(PlaneModel, JacobianMatchesFiniteDifferences) {
  Plane plane;
  plane.normal = Eigen::Vector3d(0.2, -0.5, 0.7).normalized();
  plane.point = {5.0, 1.0, 2.0};
  const Eigen::Vector3d p(3.0, -4.0, 1.5);
  const auto residual = [&](const NominalState& s) {
    return Eigen::Matrix<double, 1, 1>(
        plane_row(plane, p, s.rotation.toRotationMatrix(), s.position).residual);
  };
  const NominalState state = test::some_state();
  const auto numeric = test::numeric_jacobian<1>(state, residual);
  const PlaneRow row = plane_row(plane, p, state.rotation.toRotationMatrix(), state.position);
  EXPECT_LT((row.jacobian.transpose() - numeric.leftCols<6>()).cwiseAbs().maxCoeff(), 1e-8);
  EXPECT_LT(numeric.rightCols<ErrorState::kSize - 6>().cwiseAbs().maxCoeff(), 1e-12);
}

TEST(PlaneModel, FitsExactPlanes) {
  RandomStream random(1, "plane");
  for (int i = 0; i < 50; ++i) {
    const Eigen::Vector3d normal = random.normal3().normalized();
    const Plane plane = plane_of(spread_on_plane(normal, 0.0, random));
    ASSERT_TRUE(plane.valid);
    EXPECT_GT(std::abs(plane.normal.dot(normal)), 1.0 - 1e-6);
  }
}

TEST(PlaneModel, RejectsOneScanLine) {
  PlanePoints line;
  for (std::size_t i = 0; i < 5; ++i)
    line[i] = {0.1F * static_cast<float>(i), 1.0F, 0.001F * static_cast<float>(i % 2)};
  EXPECT_FALSE(plane_of(line).valid);
}

// One ring crosses from a wall to the ground: its five points lie in the cone of the beams, and the
// plane through them is neither surface.
TEST(PlaneModel, RejectsOneScanLineBentAroundACorner) {
  const PlanePoints bent = {{{1.0F, 1.1F, -0.10F},
                             {1.1F, 1.1F, -0.15F},
                             {1.2F, 1.1F, -0.20F},
                             {1.3F, 1.05F, -0.21F},
                             {1.35F, 1.0F, -0.21F}}};
  EXPECT_FALSE(plane_of(bent).valid);
}

// Whether that is too thick depends on the noise of the residuals, which the matcher knows.
TEST(PlaneModel, StatesTheLargestDistanceFromIt) {
  RandomStream random(1, "plane");
  auto points = spread_on_plane(Eigen::Vector3d::UnitZ(), 0.0, random);
  EXPECT_LT(plane_of(points).thickness, 1e-6);
  for (std::size_t i : {0, 1}) points[i].z() += 0.02F;
  const Plane plane = plane_of(points);
  ASSERT_TRUE(plane.valid);
  double largest = 0.0;
  for (const Eigen::Vector3f& p : points) {
    largest = std::max(largest, std::abs(plane.normal.dot(p.cast<double>() - plane.point)));
  }
  EXPECT_NEAR(plane.thickness, largest, 1e-12);
  EXPECT_GT(plane.thickness, 0.008);
}

TEST(PlaneModel, RejectsPointsFarOffThePlane) {
  RandomStream random(1, "plane");
  auto points = spread_on_plane(Eigen::Vector3d::UnitZ(), 0.0, random);
  points[4].z() += 0.3F;
  EXPECT_FALSE(plane_of(points).valid);
}

TEST(PlaneModel, RejectsIdenticalPoints) {
  PlanePoints points;
  points.fill({1.0F, 2.0F, 3.0F});
  EXPECT_FALSE(plane_of(points).valid);
}

// Wall points on either side of what a near edge hides, and a return from the hidden part: it lies
// among them. One beyond the last of them does not.
TEST(PlaneModel, AReturnLiesAmongThePointsOfItsPlaneOrBesideThem) {
  const PlanePoints points = {{{-0.2F, -0.2F, 0.0F},
                               {-0.2F, 0.2F, 0.0F},
                               {0.2F, -0.2F, 0.0F},
                               {0.2F, 0.2F, 0.0F},
                               {0.0F, 0.0F, 0.0F}}};
  // The deviation along x, and along y, is 0.2 m sqrt(4/5) = 0.179 m; height does not count.
  for (const float height : {0.0F, 1.0F, -3.0F}) {
    EXPECT_TRUE(plane_at(points, {0.0F, 0.0F, height}).valid);
    EXPECT_TRUE(plane_at(points, {0.26F, 0.0F, height}).valid);
    EXPECT_FALSE(plane_at(points, {0.28F, 0.0F, height}).valid);
    EXPECT_FALSE(plane_at(points, {0.0F, -0.28F, height}).valid);
  }
}

// Points in a strip: the limit follows the direction.
TEST(PlaneModel, TheLimitOfAReturnFollowsTheSpreadOfThePoints) {
  const PlanePoints points = {{{-1.0F, 0.06F, 0.0F},
                               {-0.5F, -0.06F, 0.0F},
                               {0.0F, 0.06F, 0.0F},
                               {0.5F, -0.06F, 0.0F},
                               {1.0F, 0.0F, 0.0F}}};
  EXPECT_TRUE(plane_at(points, {1.0F, 0.0F, 0.0F}).valid);
  EXPECT_FALSE(plane_at(points, {0.0F, 0.3F, 0.0F}).valid);
}

}  // namespace
}  // namespace aims
