// SPDX-License-Identifier: BSD-3-Clause
#include <cmath>

#include "sim/environment/junction.hpp"
#include "sim/environment/tunnel.hpp"
#include "tests/sim/environment/scene_checks.hpp"

namespace aims {
namespace {

using Eigen::Vector3d;
using testing::distance;

SceneConfig junction() {
  SceneConfig config;
  config.kind = SceneKind::kJunction;
  return config;
}

SceneConfig tunnel(double radius) {
  SceneConfig config;
  config.kind = SceneKind::kTunnel;
  config.tunnel.radius = radius;
  return config;
}

/// On the centre line at arc length `s`, moved outwards by `offset` [m], 0.7 m high.
Vector3d arc_point(double radius, double s, double offset = 0.0) {
  const double r = radius + offset;
  return {r * std::sin(s / radius), radius - r * std::cos(s / radius), 0.7};
}

TEST(JunctionScene, HasAStemAndTwoBranchesWithDeadEnds) {
  SceneConfig config = junction();
  config.junction.doors.sides = WallSides::kNone;
  const RayCaster caster(build_scene(config, 1));
  const Vector3d x = Vector3d::UnitX();
  const Vector3d y = Vector3d::UnitY();
  EXPECT_NEAR(distance(caster, {0.0, 0.3, 1.0}, -x), 12.0, 1e-4);
  EXPECT_NEAR(distance(caster, {0.0, 0.3, 1.0}, x), 14.1, 1e-4) << "the crossing's far wall";
  EXPECT_NEAR(distance(caster, {13.0, 0.0, 1.0}, y), 24.0, 1e-4);
  EXPECT_NEAR(distance(caster, {13.0, 0.0, 1.0}, -y), 24.0, 1e-4);
  for (double s = 1.3; s < 23.0; s += 1.1) {
    for (const double side : {-1.0, 1.0}) {
      EXPECT_NEAR(distance(caster, {13.0, side * s, 1.0}, x), 1.1, 1e-4);
      EXPECT_NEAR(distance(caster, {13.0, side * s, 1.0}, -x), 1.1, 1e-4);
    }
  }
  for (double s = -11.0; s < 11.8; s += 1.1) {
    EXPECT_NEAR(distance(caster, {s, 0.2, 1.0}, y), 0.9, 1e-4);
    EXPECT_NEAR(distance(caster, {s, 0.2, 1.0}, -y), 1.3, 1e-4);
  }
}

TEST(JunctionScene, NoRayLeaksOut) {
  for (const std::uint64_t seed : {1, 2, 3}) {
    const Scene scene = build_scene(junction(), seed);
    testing::expect_no_leak(scene, {{0.0, 0.0, 0.5}, {11.95, 0.0, 0.5}, {13.0, -6.0, 0.5}}, seed);
    EXPECT_LT(testing::colliding_solids(scene), 12);
  }
}

TEST(TunnelScene, WallsFollowTheArcToAMillimetre) {
  for (const double radius : {40.0, 20.0, 10.0}) {
    SceneConfig config = tunnel(radius);
    config.tunnel.doors.sides = WallSides::kNone;
    const RayCaster caster(build_scene(config, 1));
    for (double s = -11.9; s < 36.9; s += 0.37) {
      const Vector3d here = arc_point(radius, s);
      const Vector3d outwards = arc_point(radius, s, 1.0) - here;
      EXPECT_NEAR(distance(caster, here, outwards), 1.1, 1e-3) << radius << " at " << s;
      EXPECT_NEAR(distance(caster, here, -outwards), 1.1, 1e-3) << radius << " at " << s;
      EXPECT_NEAR(distance(caster, here, Vector3d::UnitZ()), 1.9, 1e-4);
      EXPECT_NEAR(distance(caster, here, -Vector3d::UnitZ()), 0.7, 1e-4);
    }
    const Vector3d begin = arc_point(radius, -11.5);
    const Vector3d back = arc_point(radius, -12.0) - begin;
    EXPECT_NEAR(distance(caster, begin, back), back.norm(), 0.01) << "end wall";
  }
}

TEST(TunnelScene, DoorsAreSetBackIntoTheArc) {
  SceneConfig config = tunnel(10.0);
  config.tunnel.doors = {.sides = WallSides::kBoth, .spacing = 8.0, .jitter = 0.0, .depth = 0.05};
  const RayCaster caster(build_scene(config, 1));
  int doors = 0;
  for (double s = -8.0; s < 36.0; s += 8.0, ++doors) {
    const Vector3d here = arc_point(10.0, s);
    const Vector3d outwards = arc_point(10.0, s, 1.0) - here;
    // In the middle of a door its flat face is nearer to the centre by the chord's height.
    const auto chord_height = [](double r) { return r - std::sqrt(r * r - 0.55 * 0.55); };
    EXPECT_NEAR(distance(caster, here, outwards), 1.15 - chord_height(11.1), 2e-3) << s;
    EXPECT_NEAR(distance(caster, here, -outwards), 1.15 + chord_height(8.9), 2e-3) << s;
  }
  EXPECT_EQ(doors, 6);
}

TEST(TunnelScene, NoRayLeaksOut) {
  for (const double radius : {40.0, 10.0}) {
    const Scene scene = build_scene(tunnel(radius), 1);
    testing::expect_no_leak(scene, {arc_point(radius, 0.0), arc_point(radius, 20.0, 0.9)});
    EXPECT_LT(testing::colliding_solids(scene), 50);
  }
}

TEST(TunnelScene, SlabsThatCollideStayNearTheWallsThatAreSeen) {
  const double radius = 10.0;
  const Scene scene = build_scene(tunnel(radius), 1);
  Scene slabs;
  for (Solid solid : scene.solids) {
    if (!solid.collides) continue;
    solid.visible = true;
    slabs.solids.push_back(solid);
  }
  const RayCaster caster(slabs);
  for (double s = -11.0; s < 36.0; s += 0.31) {
    const Vector3d here = arc_point(radius, s);
    const Vector3d outwards = arc_point(radius, s, 1.0) - here;
    EXPECT_NEAR(distance(caster, here, outwards), 1.1, 0.1) << s;
    EXPECT_NEAR(distance(caster, here, -outwards), 1.1, 0.1) << s;
  }
}

TEST(BuildingScenes, ConfigurationsThatCannotBeBuiltNameTheKey) {
  SceneConfig config = tunnel(6.0);
  const auto closed = validate(config);
  ASSERT_FALSE(closed) << "49 m do not fit into one turn of 38 m";
  EXPECT_NE(closed.error().message.find("scene.tunnel.length"), std::string::npos);
  config = tunnel(10.0);
  config.tunnel.doors.height = 3.0;
  EXPECT_NE(validate(config).error().message.find("scene.tunnel.doors.height"), std::string::npos);
  config = junction();
  config.junction.doors.spacing = 0.9;
  EXPECT_NE(validate(config).error().message.find("scene.junction.doors.spacing"),
            std::string::npos);
  config = junction();
  config.ramp.grade = 0.1;
  EXPECT_NE(validate(config).error().message.find("scene.ramp"), std::string::npos);
  config = junction();
  config.people = {.count = 1, .lane_offset = 2.0};
  EXPECT_NE(validate(config).error().message.find("scene.people"), std::string::npos);
}

}  // namespace
}  // namespace aims
