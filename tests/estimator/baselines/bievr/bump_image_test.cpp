// SPDX-License-Identifier: BSD-3-Clause
#include "estimator/baselines/bievr/bump_image.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>

#include "tests/estimator/baselines/bievr/wavy_wall.hpp"

namespace aims::bievr {
namespace {

using testing::WavyWall;

/// Of the wall's face at x: its distance from the map's surface along the wall's normal [m].
double error_at(const BumpMap& map, const WavyWall& wall, double x, double z) {
  const Eigen::Vector3d p = wall.at(x, z);
  const BumpVoxel* voxel = map.nearest(p);
  if (voxel == nullptr) return HUGE_VAL;
  const Eigen::Vector3d at = voxel->image.in_image(p);
  return at.z() - voxel->image.height(at.head<2>()).value_or(HUGE_VAL);
}

/// Whether x is so near the edge of a voxel of 0.5 m that an image lacks pixels or has half of one.
bool at_edge(double x) { return std::abs(x - 0.5 * std::round(x / 0.5)) < 0.13; }

TEST(BumpImage, HasTheHeightOfAWavyWall) {
  const WavyWall wall;
  const BumpMap map = testing::map_of(testing::points_of(wall, 4.0, 1.0, 0.005), testing::sharp());
  for (double x = 0.12; x < 3.9; x += 0.037) {
    if (at_edge(x)) continue;
    // A pixel has the mean over its width, and between pixels the height is linear: h'' s^2 / 6.
    const double curvature = wall.amplitude * wall.wave() * wall.wave();
    EXPECT_NEAR(error_at(map, wall, x, 0.3), 0.0, curvature * 0.05 * 0.05 / 5.0) << x;
  }
}

TEST(BumpImage, HasTheSlopeOfAWavyWall) {
  const WavyWall wall{.amplitude = 0.01, .wavelength = 0.8};
  const BumpMap map = testing::map_of(testing::points_of(wall, 4.0, 1.0, 0.005), testing::sharp());
  int compared = 0;
  for (double x = 0.12; x < 3.9; x += 0.037) {
    if (at_edge(x)) continue;
    const BumpVoxel* voxel = map.nearest(wall.at(x, 0.3));
    const Eigen::Vector3d at = voxel->image.in_image(wall.at(x, 0.3));
    const auto height = voxel->image.sample(at.head<2>());
    ASSERT_TRUE(height);
    // The gradient in the world: n_image turned; along x it is -n_x / n_y of the face.
    const Eigen::Vector3d n = voxel->image.R_image_world().transpose() *
                              Eigen::Vector3d(-height->slope.x(), -height->slope.y(), 1.0);
    EXPECT_NEAR(-n.x() / n.y(), wall.slope(x), 0.08 * wall.amplitude * wall.wave()) << x;
    EXPECT_NEAR(n.z() / n.y(), 0.0, 0.01) << x;
    ++compared;
  }
  EXPECT_GT(compared, 40);
}

/// Smoothing along one axis is the kernel (e, 1, e), e = exp(-1 / (2 0.8^2)).
TEST(BumpImage, SmoothingDampsAWaveByTheKernelsResponse) {
  const double wavelength = 0.3;
  const double pixel = 0.05;
  MapConfig config;
  BumpImage smooth(Eigen::Vector3d::Zero(), Eigen::Vector3d::UnitZ(), Eigen::Vector3d::Zero(),
                   config);
  const double k = 2.0 * std::numbers::pi / wavelength;
  // One point per pixel, at its centre.
  for (int row = 0; row < 10; ++row) {
    for (int column = 0; column < 10; ++column) {
      const Eigen::Vector3d centre(column * pixel, row * pixel, 0.0);
      const Eigen::Vector3d origin = smooth.in_image(Eigen::Vector3d::Zero());
      Eigen::Vector3d p = smooth.R_image_world().transpose() * (centre - origin);
      smooth.add(p + 0.01 * std::sin(k * centre.x()) * Eigen::Vector3d::UnitZ(), 1.0F);
    }
  }
  smooth.smooth(true);
  const double e = std::exp(-1.0 / (2.0 * 0.8 * 0.8));
  const double response = (1.0 + 2.0 * e * std::cos(k * pixel)) / (1.0 + 2.0 * e);
  for (int column = 2; column < 8; ++column) {
    const Eigen::Vector2d at(column * pixel, 4 * pixel);
    EXPECT_NEAR(smooth.height(at).value(), response * 0.01 * std::sin(k * at.x()), 1e-6);
  }
}

TEST(BumpImage, KeepsItsSurfaceWhenThePlaneTurns) {
  const WavyWall wall{.amplitude = 0.002, .wavelength = 1.0};
  MapConfig config = testing::sharp();
  BumpVoxel voxel;
  std::vector<MapPoint> all = testing::points_of(wall, 0.5, 0.5, 0.01);
  // Its lower edge alone has another plane than the whole.
  const auto part = all.begin() + 250;
  for (auto it = all.begin(); it != part; ++it) it->p_world.y() += 0.3 * it->p_world.z();
  voxel.add({all.begin(), part}, Eigen::Vector3d::Zero(), config);
  const Eigen::Vector3d first = voxel.image.R_image_world().row(2);
  voxel.add({part, all.end()}, Eigen::Vector3d::Zero(), config);
  const Eigen::Vector3d second = voxel.image.R_image_world().row(2);
  EXPECT_LT(std::abs(first.dot(second)), std::cos(config.normal_tolerance / 57.3));
  int near = 0;
  for (const MapPoint& point : all) {
    const Eigen::Vector3d at = voxel.image.in_image(point.p_world);
    const auto height = voxel.image.height(at.head<2>());
    near += height && std::abs(*height - at.z()) < 0.01 ? 1 : 0;
  }
  EXPECT_GT(near, 0.9 * static_cast<double>(all.size()));
}

TEST(BumpImage, WeighsNearPointsMore) {
  MapConfig config;
  BumpVoxel voxel;
  const auto at = [](double x, double y, double z) { return Eigen::Vector3d(x, y, z); };
  voxel.add(std::vector<MapPoint>{{at(0.1, 0.1, 0.2), 4.0},
                                  {at(0.4, 0.1, 0.2), 4.0},
                                  {at(0.1, 0.4, 0.2), 4.0},
                                  {at(0.4, 0.4, 0.2), 4.0}},
            Eigen::Vector3d::Zero(), config);
  // 1 / 8 on 1 / 4: a third of the height.
  voxel.add(std::vector<MapPoint>{{at(0.1, 0.1, 0.203), 8.0}}, Eigen::Vector3d::Zero(), config);
  const Eigen::Vector3d pixel = voxel.image.in_image(at(0.1, 0.1, 0.2));
  EXPECT_NEAR(std::abs(voxel.image.height(pixel.head<2>()).value()), 0.001, 1e-5);
}

TEST(BumpImage, UnseenPixelsHaveNoHeight) {
  const WavyWall wall;
  const BumpMap map = testing::map_of(testing::points_of(wall, 0.2, 0.5, 0.01), testing::sharp());
  const BumpVoxel* voxel = map.nearest(wall.at(0.1, 0.2));
  ASSERT_NE(voxel, nullptr);
  EXPECT_FALSE(voxel->image.height(voxel->image.in_image(wall.at(0.4, 0.2)).head<2>()));
}

}  // namespace
}  // namespace aims::bievr
