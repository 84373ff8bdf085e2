// SPDX-License-Identifier: BSD-3-Clause
#include "sim/environment/surface_relief.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "sim/environment/ray_caster.hpp"
#include "sim/environment/scene_config.hpp"

namespace aims {
namespace {

using Eigen::Vector3d;
constexpr std::uint64_t kSeed = 5;
constexpr double kRelief = 0.002;  // [m]

/// A wall of 40 m by 3 m whose smooth face lies at y = 2, facing -y.
Scene wall_with(const SurfaceConfig& surface) {
  Scene scene;
  Solid wall;
  wall.half_extents = Vector3d(20.0, 0.1, 1.5);
  wall.T_world_solid.translation = Vector3d(0.0, 2.1, 1.5);
  scene.solids.push_back(wall);
  scene.surface = surface;
  scene.surface_seed = kSeed;
  return scene;
}

SurfaceConfig relief_of(double relief) {
  SurfaceConfig surface;
  surface.relief = relief;
  return surface;
}

/// Height of the relief above the smooth face, seen by a ray along the normal [m].
double height_at(const RayCaster& caster, double x, double z) {
  return 2.0 - caster.cast({x, 0.0, z}, Vector3d::UnitY())->distance;
}

std::vector<double> profile(const RayCaster& caster, double step) {
  std::vector<double> heights;
  for (double x = -19.0; x < 19.0; x += step) heights.push_back(height_at(caster, x, 1.2));
  return heights;
}

TEST(SurfaceRelief, HasTheDeviationOfTheConfiguration) {
  const RayCaster caster(wall_with(relief_of(kRelief)));
  double sum = 0.0;
  double squares = 0.0;
  int count = 0;
  for (double z = 0.2; z < 2.9; z += 0.3) {
    for (double x = -19.0; x < 19.0; x += 0.11, ++count) {
      const double height = height_at(caster, x, z);
      sum += height;
      squares += height * height;
    }
  }
  EXPECT_NEAR(sum / count, 0.0, 0.2 * kRelief);
  EXPECT_NEAR(std::sqrt(squares / count), kRelief, 0.15 * kRelief);
}

// A finished wall: at most 5 mm between ends of 1 m, 10 mm of 4 m, nearly everywhere.
TEST(SurfaceRelief, OfOneAndAHalfMillimetresMeetsTheToleranceOfFinishedWalls) {
  constexpr double kStep = 0.02;
  const std::vector<double> heights = profile(RayCaster(wall_with(relief_of(0.0015))), kStep);
  for (const auto& [length, tolerance] : {std::pair(1.0, 0.005), {4.0, 0.010}}) {
    const auto count = static_cast<std::size_t>(std::lround(length / kStep));
    int within = 0;
    int all = 0;
    double largest = 0.0;
    for (std::size_t first = 0; first + count < heights.size(); first += 10, ++all) {
      double gap = 0.0;
      for (std::size_t i = 0; i <= count; ++i) {
        const double part = static_cast<double>(i) / static_cast<double>(count);
        const double chord = (1.0 - part) * heights[first] + part * heights[first + count];
        gap = std::max(gap, std::abs(heights[first + i] - chord));
      }
      if (gap <= tolerance) ++within;
      largest = std::max(largest, gap);
    }
    EXPECT_GE(within, 0.99 * all) << length << " m";
    EXPECT_GT(largest, 0.3 * tolerance) << length << " m: too smooth to be a wall";
  }
}

// Rays from elsewhere meet the surface that rays along the normal have measured.
TEST(SurfaceRelief, IsOneSurfaceFromAllSides) {
  const RayCaster caster(wall_with(relief_of(kRelief)));
  RandomStream random = rng(kSeed, "sides");
  for (int i = 0; i < 3000; ++i) {
    const Vector3d from(random.uniform(-7.0, 7.0), 0.0, 1.5);
    const Vector3d towards(from.x() + random.uniform(-12.0, 12.0), 2.0, random.uniform(0.3, 2.7));
    const Vector3d direction = (towards - from).normalized();
    const auto hit = caster.cast(from, direction);
    ASSERT_TRUE(hit);
    const Vector3d point = from + hit->distance * direction;
    EXPECT_NEAR(2.0 - point.y(), height_at(caster, point.x(), point.z()), 1.5e-4)
        << "from " << from.transpose() << " to " << towards.transpose();
  }
}

TEST(SurfaceRelief, NormalsAreThoseOfTheHeights) {
  const RayCaster caster(wall_with(relief_of(kRelief)));
  RandomStream random = rng(kSeed, "normals");
  constexpr double kStep = 0.004;
  std::vector<double> errors;
  for (int i = 0; i < 2000; ++i) {
    const double x = random.uniform(-15.0, 15.0);
    const double z = random.uniform(0.3, 2.7);
    const double slope_x =
        (height_at(caster, x + kStep, z) - height_at(caster, x - kStep, z)) / (2.0 * kStep);
    const double slope_z =
        (height_at(caster, x, z + kStep) - height_at(caster, x, z - kStep)) / (2.0 * kStep);
    const Vector3d expected = Vector3d(-slope_x, -1.0, -slope_z).normalized();
    errors.push_back((caster.cast({x, 0.0, z}, Vector3d::UnitY())->normal - expected).norm());
  }
  // A third of the differences spans a node of the grid, where the slope of the field jumps.
  std::ranges::nth_element(errors, errors.begin() + 1200);
  EXPECT_LT(errors[1200], 5e-4);
}

TEST(SurfaceRelief, LeavesGlassAndCylindersSmooth) {
  Scene scene = wall_with(relief_of(kRelief));
  scene.solids[0].material.return_cosine = 0.5;
  Solid pillar;
  pillar.shape = Shape::kCylinder;
  pillar.half_extents = Vector3d(0.3, 0.3, 1.5);
  pillar.T_world_solid.translation = Vector3d(0.0, -2.0, 1.5);
  scene.solids.push_back(pillar);
  const RayCaster rough(scene);
  scene.surface = {};
  const RayCaster smooth(scene);
  for (double x = -5.0; x < 5.0; x += 0.1) {
    EXPECT_NEAR(height_at(rough, x, 1.0), 0.0, 1e-6);
    const Vector3d towards = Vector3d(0.2 * x / 5.0, -2.0, 0.0).normalized();
    EXPECT_EQ(rough.cast({0.0, 0.0, 1.0}, towards)->distance,
              smooth.cast({0.0, 0.0, 1.0}, towards)->distance);
  }
}

TEST(SurfaceRelief, OfTwoSeedsDiffersAndOfOneDoesNot) {
  Scene scene = wall_with(relief_of(kRelief));
  const std::vector<double> once = profile(RayCaster(scene), 0.5);
  EXPECT_EQ(profile(RayCaster(scene), 0.5), once);
  scene.surface_seed = kSeed + 1;
  EXPECT_NE(profile(RayCaster(scene), 0.5), once);
}

TEST(SurfaceRelief, TextureChangesTheReflectivityOnly) {
  SurfaceConfig surface;
  surface.texture = 0.2;
  const Scene scene = wall_with(surface);
  const RayCaster caster(scene);
  double sum = 0.0;
  double squares = 0.0;
  int count = 0;
  for (double x = -18.0; x < 18.0; x += 0.5) {
    RayPacket rays;
    for (int lane = 0; lane < kRayPacketSize; ++lane) {
      rays.origin_x[lane] = static_cast<float>(x + 0.03 * lane);
      rays.origin_z[lane] = 1.0F;
      rays.direction_y[lane] = 1.0F;
    }
    HitPacket hits;
    caster.cast(rays, 10.0F, hits);
    for (int lane = 0; lane < kRayPacketSize; ++lane, ++count) {
      EXPECT_FLOAT_EQ(hits.distance[lane], 2.0F);
      const double logarithm = std::log(hits.texture[lane]);
      sum += logarithm;
      squares += logarithm * logarithm;
    }
  }
  EXPECT_NEAR(sum / count, 0.0, 0.06);
  EXPECT_NEAR(std::sqrt(squares / count), 0.2, 0.05);
}

SurfaceConfig boards() {
  SurfaceConfig surface;
  surface.panels.spacing = 1.25;
  return surface;
}

// The crown c (1 - q^2)^2 over a joint of width w has slopes of mean square 512 c^2 / (105 w s) on
// a wall with joints s apart.
TEST(SurfaceRelief, JointsHaveTheSlopesOfTheirCrowns) {
  const SurfaceConfig surface = boards();
  const RayCaster caster(wall_with(surface));
  const PanelConfig& panels = surface.panels;
  double squares = 0.0;
  double highest = 0.0;
  int count = 0;
  for (double x = -15.0; x < 15.0; x += 0.001, ++count) {
    const auto hit = caster.cast({x, 0.0, 1.2}, Vector3d::UnitY());
    squares += std::pow(hit->normal.x() / hit->normal.y(), 2);
    highest = std::max(highest, 2.0 - hit->distance);
    EXPECT_NEAR(hit->normal.z(), 0.0, 1e-6);
  }
  const double expected =
      512.0 * panels.crown * panels.crown / (105.0 * panels.width * panels.spacing);
  EXPECT_NEAR(squares / count, expected, 0.01 * expected);
  EXPECT_NEAR(highest, panels.crown, 1e-5);
}

TEST(SurfaceRelief, JointsRepeatAtTheirSpacingOnWallsOnly) {
  Scene scene = wall_with(boards());
  const RayCaster caster(scene);
  for (double x = -15.0; x < 10.0; x += 0.17) {
    EXPECT_NEAR(height_at(caster, x, 1.0), height_at(caster, x + 1.25, 2.0), 2e-6);
    EXPECT_FLOAT_EQ(caster.cast({0.6 * x, 0.0, 1.0}, -Vector3d::UnitZ())->distance, 1.0);
  }
}

TEST(SurfaceRelief, JointsWiderThanTheirSpacingAreRefused) {
  SceneConfig config;
  config.surface = boards();
  config.surface.panels.width = 1.5;
  const Result<void> checked = validate(config);
  ASSERT_FALSE(checked);
  EXPECT_NE(checked.error().message.find("scene.surface.panels.width"), std::string::npos);
}

TEST(SurfaceRelief, LampsHangUnderTheCeilingAtTheirSpacing) {
  SceneConfig config;
  config.corridor.lamps.spacing = 2.5;
  const RayCaster caster(build_scene(config, 1));
  const LampConfig& lamps = config.corridor.lamps;
  for (double x = 0.0; x < 60.0; x += 0.07) {
    const double apart = std::abs(x - 2.5 * std::round(x / 2.5));
    if (std::abs(apart - 0.5 * lamps.length) < 0.01) continue;  // at its end
    const double expected =
        config.corridor.height - (apart < 0.5 * lamps.length ? lamps.height : 0.0) - 1.0;
    EXPECT_NEAR(caster.cast({x, 0.0, 1.0}, Vector3d::UnitZ())->distance, expected, 1e-5) << x;
  }
}

TEST(SurfaceRelief, WavesOfTheWrongOrderAreRefused) {
  SceneConfig config;
  config.surface.shortest = 2.0;
  config.surface.longest = 1.0;
  const Result<void> checked = validate(config);
  ASSERT_FALSE(checked);
  EXPECT_NE(checked.error().message.find("scene.surface.shortest"), std::string::npos);
}

}  // namespace
}  // namespace aims
