// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "estimator/baselines/points/translation_constraint.hpp"
#include "estimator/lidar/point_choice.hpp"

namespace aims::points {
namespace {

TEST(PointChoice, EveryNthBeyondTheMinimumRange) {
  LidarScan scan;
  for (int i = 0; i < 12; ++i) scan.points.push_back({{i < 6 ? 0.4F : 4.0F, 0.0F, 0.0F}});
  scan.points[9].position.x() = std::numeric_limits<float>::quiet_NaN();
  EXPECT_EQ(chosen_points(scan, 3, 0.5), (std::vector<int>{6}));
  EXPECT_EQ(chosen_points(scan, 3, 0.1), (std::vector<int>{0, 3, 6}));
}

TEST(VoxelCentroids, AreThoseOfTheVoxelsInOrder) {
  const std::vector<Eigen::Vector3f> points = {
      {0.1F, 0.1F, 0.1F}, {0.3F, 0.3F, 0.3F}, {0.6F, 0.1F, 0.1F}, {-0.1F, 0.1F, 0.1F}};
  const auto centroids = voxel_centroids(points, 0.5);
  ASSERT_EQ(centroids.size(), 3U);
  EXPECT_TRUE(centroids[0].isApprox(points[3]));
  EXPECT_TRUE(centroids[1].isApprox(Eigen::Vector3f(0.2F, 0.2F, 0.2F)));
  EXPECT_TRUE(centroids[2].isApprox(points[2]));
}

TEST(VoxelCentroids, FurtherEntriesAreAveragedAndMakeNoVoxels) {
  const std::vector<Eigen::Vector4f> points = {{0.1F, 0.1F, 0.1F, 7.0F}, {0.3F, 0.1F, 0.1F, 9.0F}};
  const auto centroids = voxel_centroids(points, 0.5);
  ASSERT_EQ(centroids.size(), 1U);
  EXPECT_TRUE(centroids[0].isApprox(Eigen::Vector4f(0.2F, 0.1F, 0.1F, 8.0F)));
}

// Walls across y and z constrain these directions; x has what their tilt leaves to it.
TEST(TranslationConstraint, TheWeakestDirectionIsThatAlongTheWalls) {
  Eigen::Matrix<double, 30, 3> normals;
  for (int i = 0; i < 30; ++i) {
    normals.row(i) = i % 2 == 0 ? Eigen::Vector3d(0, 1, 0) : Eigen::Vector3d(0, 0, 1);
  }
  normals.row(0) = Eigen::Vector3d(1, 0, 0);
  normals.row(1) = Eigen::Vector3d(0.1, 0.0, std::sqrt(0.99));
  const TranslationConstraint constraint = translation_constraint(normals);
  EXPECT_NEAR(constraint.smallest, 1.0, 0.02);
  EXPECT_NEAR(constraint.condition, 14.9, 0.2);
  EXPECT_NEAR(constraint.localizability, 1.0, 0.01);  // the tilt of row 1 is below the limit
}

TEST(TranslationConstraint, WithoutPlanesThereIsNone) {
  EXPECT_TRUE(std::isnan(translation_constraint(Eigen::Matrix<double, 0, 3>()).smallest));
}

}  // namespace
}  // namespace aims::points
