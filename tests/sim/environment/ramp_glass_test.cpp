// SPDX-License-Identifier: BSD-3-Clause
#include <cmath>
#include <numbers>

#include "sim/environment/ramp.hpp"
#include "sim/environment/wall.hpp"
#include "tests/sim/environment/scene_checks.hpp"

namespace aims {
namespace {

using Eigen::Vector3d;
using testing::distance;

SceneConfig corridor_with_ramp() {
  SceneConfig config;
  config.corridor.length = 25.0;
  config.corridor.margin = 12.0;
  config.ramp = {.start = 8.0, .length = 8.0, .grade = 0.1};
  return config;
}

SceneConfig glass_corridor(double share) {
  SceneConfig config;
  config.corridor.length = 25.0;
  config.corridor.doors.sides = WallSides::kNone;
  config.corridor.glass.fraction = share;
  return config;
}

/// Direction in the plane at `degrees` from the left wall's normal.
Vector3d off_normal(double degrees) {
  const double angle = degrees * std::numbers::pi / 180.0;
  return {std::sin(angle), std::cos(angle), 0.0};
}

bool is_glass(const RayCaster& caster, const RayHit& hit) {
  return caster.materials()[static_cast<std::size_t>(hit.surface)].return_cosine > 0.0;
}

TEST(RampScene, FloorRisesBetweenItsEndsAndStaysUp) {
  const Scene scene = build_scene(corridor_with_ramp(), 1);
  const RayCaster caster(scene);
  const auto expected = [](double x) { return 0.1 * std::clamp(x - 8.0, 0.0, 8.0); };
  RandomStream random = rng(3, "ramp");
  for (int i = 0; i < 500; ++i) {
    const double x = random.uniform(-11.0, 36.0);
    const double y = random.uniform(-1.0, 1.0);
    ASSERT_NEAR(floor_height(scene.floor, x, y), expected(x), 1e-6) << x;
    ASSERT_NEAR(distance(caster, {x, y, 1.8}, -Vector3d::UnitZ()), 1.8 - expected(x), 1e-5) << x;
    ASSERT_NEAR(distance(caster, {x, y, 1.8}, Vector3d::UnitZ()), 0.8 + expected(x), 1e-5) << x;
  }
}

TEST(RampScene, NoRayLeaksOutAndDoorsStandOnTheirFloor) {
  SceneConfig config = corridor_with_ramp();
  config.corridor.doors.jitter = 0.0;
  const Scene scene = build_scene(config, 1);
  testing::expect_no_leak(scene, {{0.0, 0.0, 0.5}, {8.0, 0.0, 1.0}, {16.0, 0.0, 1.5}});
  const RayCaster caster(scene);
  // Door centres are at -8, 0, 8, 16, ...; lintels 2.05 m over the floor, recesses of 15 cm.
  for (const auto& [x, floor] : {std::pair{0.0, 0.0}, {8.0, 0.0}, {16.0, 0.8}, {24.0, 0.8}}) {
    EXPECT_NEAR(distance(caster, {x, 0.0, floor + 2.04}, -Vector3d::UnitY()), 1.25, 1e-4) << x;
    EXPECT_NEAR(distance(caster, {x, 0.0, floor + 2.06}, -Vector3d::UnitY()), 1.1, 1e-4) << x;
  }
}

TEST(RampScene, ConfigurationsThatCannotBeBuiltNameTheKey) {
  SceneConfig config = corridor_with_ramp();
  config.ramp.length = 40.0;
  EXPECT_NE(validate(config).error().message.find("scene.ramp.length"), std::string::npos);
  config = corridor_with_ramp();
  config.bumps.height = 0.01;
  EXPECT_NE(validate(config).error().message.find("scene.ramp"), std::string::npos);
}

TEST(FloorHeight, IsThatOfTheTrianglesOnBumps) {
  SceneConfig config;
  config.corridor.length = 10.0;
  config.bumps.height = 0.02;
  const Scene scene = build_scene(config, 4);
  const RayCaster caster(scene);
  RandomStream random = rng(5, "bumps");
  for (int i = 0; i < 1000; ++i) {
    const double x = random.uniform(-2.9, 12.9);
    const double y = random.uniform(-1.09, 1.09);
    const double z = 1.0 - distance(caster, {x, y, 1.0}, -Vector3d::UnitZ());
    ASSERT_NEAR(floor_height(scene.floor, x, y), z, 2e-6) << x << " " << y;
  }
}

TEST(GlassScene, ReturnsBeamsNearNormalIncidenceOnly) {
  const RayCaster caster(build_scene(glass_corridor(1.0), 1));
  for (double degrees = 0.5; degrees < 60.0; degrees += 1.0) {
    for (const double side : {1.0, -1.0}) {
      const Vector3d direction = side * off_normal(degrees);
      const auto hit = caster.cast({12.3, 0.0, 1.0}, direction);
      ASSERT_TRUE(hit);
      const double wall = degrees < 10.0 ? 1.1 : 2.1;  // the pane, or the wall a metre behind it
      EXPECT_NEAR(hit->distance * off_normal(degrees).y(), wall, 1e-4) << degrees;
      EXPECT_EQ(is_glass(caster, *hit), degrees < 10.0) << degrees;
      EXPECT_NEAR(hit->normal.y(), -side, 1e-5);
    }
  }
  EXPECT_NEAR(distance(caster, {12.3, 1.6, 1.0}, -off_normal(30.0)) * off_normal(30.0).y(), 3.7,
              1e-4)
      << "from behind one pane through both";
}

TEST(GlassScene, PacketsHitTheSameAsSingleRays) {
  const RayCaster caster(build_scene(glass_corridor(0.5), 1));
  RandomStream random = rng(11, "packets");
  for (int packet = 0; packet < 300; ++packet) {
    RayPacket rays;
    HitPacket hits;
    std::array<Vector3d, kRayPacketSize> directions;
    for (int lane = 0; lane < kRayPacketSize; ++lane) {
      directions[lane] = off_normal(random.uniform(-40.0, 40.0));
      rays.origin_x[lane] = static_cast<float>(0.05 * packet);
      rays.origin_z[lane] = 1.0F;
      rays.direction_x[lane] = static_cast<float>(directions[lane].x());
      rays.direction_y[lane] = static_cast<float>(directions[lane].y());
    }
    caster.cast(rays, 100.0F, hits);
    for (int lane = 0; lane < kRayPacketSize; ++lane) {
      const auto single = caster.cast({0.05 * packet, 0.0, 1.0}, directions[lane]);
      ASSERT_TRUE(single);
      ASSERT_EQ(hits.surface[lane], single->surface);
      ASSERT_FLOAT_EQ(hits.distance[lane], static_cast<float>(single->distance));
    }
  }
}

TEST(GlassScene, PanesCoverTheConfiguredFractionAndLeaveOutDoors) {
  for (const double fraction : {0.25, 0.5, 1.0}) {
    const Span along{-3.0, 28.0};
    double covered = 0.0;
    for (const Span& pane : glass_panes({.fraction = fraction}, along, {}))
      covered += pane.length();
    EXPECT_NEAR(covered, fraction * 31.0, 1e-9);
    const std::vector<Span> doors = {{1.0, 1.9}, {9.2, 10.1}, {17.0, 17.9}};
    double end = along.begin;
    for (const Span& pane : glass_panes({.fraction = fraction}, along, doors)) {
      EXPECT_GE(pane.begin, end - 1e-12);
      end = pane.end;
      for (const Span& door : doors) {
        EXPECT_TRUE(pane.end <= door.begin - 0.0999 || pane.begin >= door.end + 0.0999);
      }
    }
  }
}

TEST(GlassScene, NoRayLeaksOut) {
  SceneConfig config = glass_corridor(0.5);
  config.corridor.doors.sides = WallSides::kRight;
  testing::expect_no_leak(build_scene(config, 1), {{0.0, 0.0, 0.5}, {12.3, 0.5, 1.5}});
  config.corridor.glass.fraction = 1.0;
  testing::expect_no_leak(build_scene(config, 1), {{12.3, 0.5, 1.5}, {5.0, 1.6, 1.5}});
}

TEST(GlassScene, ASecondWallWithinTheFirstIsRefused) {
  SceneConfig config = glass_corridor(0.5);
  config.corridor.glass.backing_distance = 0.5;
  config.corridor.doors.depth = 0.4;
  EXPECT_NE(validate(config).error().message.find("scene.corridor.glass.backing_distance"),
            std::string::npos);
}

}  // namespace
}  // namespace aims
