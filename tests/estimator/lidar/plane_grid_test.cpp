// SPDX-License-Identifier: BSD-3-Clause
#include "estimator/lidar/plane_grid.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "core/random.hpp"

namespace aims {
namespace {

constexpr double kNoise = 0.01;  // of a return across the plane [m]
const Eigen::Vector3d kNormal = Eigen::Vector3d(0.1, -0.2, 1.0).normalized();

/// A return of the plane through the middle of a cube of 1 m with the normal kNormal.
Eigen::Vector3d return_of_plane(RandomStream& random) {
  Eigen::Vector3d p(random.uniform(-0.5, 0.5), random.uniform(-0.5, 0.5), 0.0);
  p.z() = -(kNormal.x() * p.x() + kNormal.y() * p.y()) / kNormal.z();
  return p + kNoise * random.normal() * kNormal;
}

PlaneSums sums_of_plane(int count, RandomStream& random) {
  PlaneSums sums;
  for (int i = 0; i < count; ++i) sums.add(return_of_plane(random).cast<float>());
  return sums;
}

// A normal from n returns scatters by sigma / (sqrt(n) s) about each axis in the plane, s their
// deviation along it: 0.29 m in a cube of 1 m.
TEST(PlaneSums, NormalScattersAsTheReturnsAllow) {
  RandomStream random(1, "plane_grid.test");
  constexpr int kRuns = 400;
  constexpr int kCount = 300;
  double squares = 0.0;
  int valid = 0;
  for (int run = 0; run < kRuns; ++run) {
    const Plane plane = sums_of_plane(kCount, random).plane(1.0);
    valid += plane.valid ? 1 : 0;
    squares += kNormal.cross(plane.normal).squaredNorm() / 2.0;
  }
  EXPECT_GT(valid, 0.99 * kRuns);
  const double expected = kNoise / (std::sqrt(kCount) * std::sqrt(1.0 / 12.0));
  EXPECT_NEAR(std::sqrt(squares / kRuns), expected, 0.1 * expected);
}

TEST(PlaneSums, SaysHowThickThePlaneIs) {
  RandomStream random(2, "plane_grid.test");
  const Plane plane = sums_of_plane(300, random).plane(1.0);
  EXPECT_NEAR(plane.thickness, 1.5 * kNoise, 0.15 * kNoise);
  EXPECT_LT(std::abs(kNormal.dot(plane.point)), 0.2 * kNoise);
}

TEST(PlaneSums, FewReturnsGiveNoPlane) {
  RandomStream random(3, "plane_grid.test");
  EXPECT_FALSE(sums_of_plane(PlaneSums::kMinCount - 1, random).plane(1.0).valid);
  EXPECT_TRUE(sums_of_plane(PlaneSums::kMinCount, random).plane(1.0).valid);
}

TEST(PlaneSums, OldPlacesStay) {
  RandomStream random(4, "plane_grid.test");
  PlaneSums sums = sums_of_plane(PlaneSums::kMaxCount, random);
  const Plane before = sums.plane(1.0);
  for (int i = 0; i < 100; ++i) sums.add(Eigen::Vector3f(0.0F, 0.0F, 0.4F));
  EXPECT_EQ(sums.plane(1.0).point, before.point);
}

/// Fraction of floors accepted, whose two diagonal quarters are higher than the others.
double accepted(double height, int runs) {
  RandomStream random(6, "plane_grid.test");
  int valid = 0;
  for (int run = 0; run < runs; ++run) {
    PlaneSums sums;
    for (int i = 0; i < 300; ++i) {
      const double x = random.uniform(-0.5, 0.5);
      const double y = random.uniform(-0.5, 0.5);
      const double z = (x * y > 0.0 ? height : 0.0) + kNoise * random.normal() - 0.1;
      sums.add(Eigen::Vector3d(x, y, z).cast<float>());
    }
    valid += sums.plane(1.0).valid;
  }
  return static_cast<double>(valid) / runs;
}

TEST(PlaneSums, QuartersThatDisagreeAreNoPlane) {
  EXPECT_GT(accepted(0.0, 200), 0.95) << "noise alone";
  EXPECT_LT(accepted(1.5 * kNoise, 200), 0.05);
  EXPECT_LT(accepted(3.0 * kNoise, 200), 0.01);
}

// A side of the cube 2 deviations from a floor: part of its returns is in the next cube.
TEST(PlaneSums, APlaneThatTheCubeCutsOffIsNone) {
  RandomStream random(8, "plane_grid.test");
  for (const double clearance : {0.02, 0.2}) {
    PlaneSums sums;
    for (int i = 0; i < 300; ++i) {
      const double z = clearance - 0.5 + kNoise * random.normal();
      if (z < -0.5) continue;
      sums.add(
          Eigen::Vector3d(random.uniform(-0.5, 0.5), random.uniform(-0.5, 0.5), z).cast<float>());
    }
    EXPECT_EQ(sums.plane(1.0).valid, clearance > 0.1);
  }
}

// Noise puts the returns of a floor through the middle of a cube above and below it.
TEST(PlaneSums, APlaneThroughTheMiddleIsWhole) {
  RandomStream random(9, "plane_grid.test");
  PlaneSums sums;
  for (int i = 0; i < 300; ++i) {
    const Eigen::Vector3d p(random.uniform(-0.5, 0.5), random.uniform(-0.5, 0.5),
                            kNoise * random.normal());
    sums.add(p.cast<float>());
  }
  EXPECT_TRUE(sums.plane(1.0).valid);
}

TEST(PlaneGrid, FitsEachHalfAndNeedsBoth) {
  RandomStream random(7, "plane_grid.test");
  PlaneGrid grid(1.0);
  const Eigen::Vector3f query(7.5F, -2.5F, 0.5F);
  const auto fill = [&](std::size_t half) {
    grid.begin_insertion();
    for (int i = 0; i < 100; ++i) {
      grid.insert(query + return_of_plane(random).cast<float>(), half);
    }
    grid.end_insertion();
  };
  fill(0);
  EXPECT_FALSE(grid.planes_at(query).valid());
  fill(1);
  const PlanePair planes = grid.planes_at(query);
  ASSERT_TRUE(planes.valid());
  for (const Plane& plane : {planes.a, planes.b}) {
    EXPECT_LT(kNormal.cross(plane.normal).norm(), 0.02);
    EXPECT_LT(std::abs(kNormal.dot(plane.point - query.cast<double>())), 0.005);
  }
  EXPECT_NE(planes.a.normal, planes.b.normal) << "they share no return";
  EXPECT_FALSE(grid.planes_at(query + Eigen::Vector3f(1.0F, 0.0F, 0.0F)).valid());
}

}  // namespace
}  // namespace aims
