// SPDX-License-Identifier: BSD-3-Clause
#include "estimator/lidar/plane_voxels.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "core/random.hpp"

namespace aims {
namespace {

constexpr double kNoise = 0.02;

/// Returns of a plane through `point`, within 0.23 m of it, with noise across it.
std::vector<Eigen::Vector3f> returns_of(const Eigen::Vector3d& normal, const Eigen::Vector3d& point,
                                        int count, RandomStream& random) {
  const Eigen::Vector3d u = normal.unitOrthogonal();
  const Eigen::Vector3d v = normal.cross(u);
  std::vector<Eigen::Vector3f> points;
  for (int i = 0; i < count; ++i) {
    points.push_back((point + random.uniform(-0.23, 0.23) * u + random.uniform(-0.23, 0.23) * v +
                      kNoise * random.normal() * normal)
                         .cast<float>());
  }
  return points;
}

const Eigen::Vector3d kCenter(10.25, 0.25, 0.25);

TEST(PlaneVoxels, IncrementalSumsGiveThePlaneOfAllReturns) {
  RandomStream random(1, "plane_voxels");
  PlaneVoxels voxels(MapConfig{});
  for (int scan = 0; scan < 10; ++scan) {
    voxels.insert(returns_of(Eigen::Vector3d::UnitY(), kCenter, 10, random),
                  Eigen::Vector3f::Zero());
    voxels.plane_at(kCenter.cast<float>());
  }
  const Plane& plane = voxels.plane_at(kCenter.cast<float>());
  ASSERT_TRUE(plane.valid);
  EXPECT_GT(std::abs(plane.normal.y()), std::cos(4.0 * kNoise / (0.13 * std::sqrt(80.0))));
  EXPECT_NEAR(plane.point.y(), kCenter.y(), 4.0 * kNoise / std::sqrt(80.0));
  EXPECT_NEAR(plane.thickness, kNoise, 0.3 * kNoise);
}

TEST(PlaneVoxels, CovarianceOfTheNormalCoversItsError) {
  RandomStream random(2, "plane_voxels");
  Eigen::Matrix3d measured = Eigen::Matrix3d::Zero();
  Eigen::Matrix3d told = Eigen::Matrix3d::Zero();
  for (int i = 0; i < 500; ++i) {
    PlaneVoxels voxels(MapConfig{});
    voxels.insert(returns_of(Eigen::Vector3d::UnitY(), kCenter, 60, random),
                  Eigen::Vector3f::Zero());
    const Plane& plane = voxels.plane_at(kCenter.cast<float>());
    ASSERT_TRUE(plane.valid);
    const Eigen::Vector3d error =
        plane.normal * std::copysign(1.0, plane.normal.y()) - Eigen::Vector3d::UnitY();
    measured += error * error.transpose();
    told += plane.normal_covariance;
  }
  for (int axis : {0, 2}) EXPECT_NEAR(told(axis, axis) / measured(axis, axis), 1.0, 0.3) << axis;
}

// Two faces in one voxel are no plane; in each half there is one.
TEST(PlaneVoxels, DividesAVoxelThatHoldsACorner) {
  RandomStream random(3, "plane_voxels");
  PlaneVoxels voxels(MapConfig{});
  std::vector<Eigen::Vector3f> points;
  for (int i = 0; i < 60; ++i) {
    const double z = random.uniform(0.01, 0.24);
    const double s = random.uniform(0.01, 0.24);
    points.push_back(Eigen::Vector3d(10.0 + s, 0.02 + 0.001 * random.normal(), z).cast<float>());
    points.push_back(Eigen::Vector3d(10.48 + 0.001 * random.normal(), 0.25 + s, z).cast<float>());
  }
  voxels.insert(points, Eigen::Vector3f::Zero());
  const Plane along = voxels.plane_at({10.1F, 0.03F, 0.1F});
  const Plane across = voxels.plane_at({10.47F, 0.4F, 0.1F});
  ASSERT_TRUE(along.valid && across.valid);
  EXPECT_GT(std::abs(along.normal.y()), 0.99);
  EXPECT_GT(std::abs(across.normal.x()), 0.99);
  EXPECT_FALSE(voxels.plane_at({10.1F, 0.4F, 0.1F}).valid);
}

}  // namespace
}  // namespace aims
