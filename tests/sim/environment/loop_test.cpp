// SPDX-License-Identifier: BSD-3-Clause
#include "sim/environment/loop.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "sim/robot/scene_route.hpp"
#include "tests/sim/environment/scene_checks.hpp"

namespace aims {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;
using testing::distance;

SceneConfig loop_scene(double length = 24.0, double depth = 14.0) {
  SceneConfig config;
  config.kind = SceneKind::kLoop;
  config.loop.length = length;
  config.loop.depth = depth;
  return config;
}

RouteConfig route_around(const SceneConfig& config) {
  RouteConfig route;
  route.follow_scene = true;
  return route_in(config, route);
}

TEST(Loop, WallsStandAroundARectangleAndItsBlock) {
  SceneConfig config = loop_scene();
  config.loop.doors.sides = WallSides::kNone;
  ASSERT_TRUE(validate(config));
  const RayCaster caster(build_scene(config, 1));
  for (double x = -10.5; x < 10.6; x += 0.7) {
    EXPECT_NEAR(distance(caster, {x, 0.0, 1.0}, -Vector3d::UnitY()), 1.1, 1e-4) << x;
    EXPECT_NEAR(distance(caster, {x, 0.0, 1.0}, Vector3d::UnitY()), 1.1, 1e-4) << x;
    EXPECT_NEAR(distance(caster, {x, 14.0, 1.0}, Vector3d::UnitY()), 1.1, 1e-4) << x;
  }
  for (double y = 1.5; y < 12.6; y += 0.7) {
    EXPECT_NEAR(distance(caster, {12.0, y, 1.0}, Vector3d::UnitX()), 1.1, 1e-4) << y;
    EXPECT_NEAR(distance(caster, {-12.0, y, 1.0}, Vector3d::UnitX()), 1.1, 1e-4) << y;
  }
  // Along each side up to the outer wall of the next.
  EXPECT_NEAR(distance(caster, {0.0, 0.0, 1.0}, Vector3d::UnitX()), 13.1, 1e-4);
  EXPECT_NEAR(distance(caster, {12.0, 7.0, 1.0}, -Vector3d::UnitY()), 8.1, 1e-4);
  EXPECT_NEAR(distance(caster, {0.0, 0.0, 1.0}, Vector3d::UnitZ()), 1.6, 1e-4);
}

TEST(Loop, NoRayLeaksOutAndFewSolidsCollide) {
  for (const auto& [length, depth] : {std::pair(24.0, 14.0), {5.0, 5.0}, {60.0, 4.5}}) {
    SceneConfig config = loop_scene(length, depth);
    config.loop.doors.sides = WallSides::kBoth;
    config.loop.doors.spacing = 3.0;
    ASSERT_TRUE(validate(config)) << validate(config).error().message;
    const Scene scene = build_scene(config, 4);
    std::vector<Vector3d> inside;
    for (const RoutePoint& point : points_along(config)) inside.emplace_back(point.x, point.y, 0.5);
    testing::expect_no_leak(scene, inside);
    EXPECT_EQ(testing::colliding_solids(scene), 8);
  }
}

TEST(Loop, RouteGoesAroundToItsStartAsOftenAsThereAreLaps) {
  for (const int laps : {1, 3}) {
    SceneConfig config = loop_scene();
    config.loop.laps = laps;
    const RouteConfig route = route_around(config);
    ASSERT_TRUE(validate(route));
    const auto walkable = check_walkable(route, build_scene(config, 1), BodySize{});
    EXPECT_TRUE(walkable) << walkable.error().message;
    std::string names;
    double length = 0.0;
    double area = 0.0;
    for (std::size_t i = 0; i < route.points.size(); ++i) {
      names += route.points[i].name;
      if (i == 0) continue;
      const Vector2d from(route.points[i - 1].x, route.points[i - 1].y);
      const Vector2d to(route.points[i].x, route.points[i].y);
      length += (to - from).norm();
      area += 0.5 * (from.x() * to.y() - from.y() * to.x());
    }
    EXPECT_EQ(names, laps == 1 ? "aba" : "abababa");
    EXPECT_EQ(route.points.front().x, route.points.back().x);
    EXPECT_EQ(route.points.front().y, route.points.back().y);
    // Corners are cut by arcs of 1 m: each is shorter by 2 - pi / 2, and the area by 1 - pi / 4.
    EXPECT_NEAR(length, laps * (76.0 - 4.0 * 0.43), 0.1 * laps);
    EXPECT_NEAR(area, laps * (24.0 * 14.0 - 4.0 * 0.215), 0.2 * laps) << "counter-clockwise";
  }
}

TEST(Loop, WhatCannotBeBuiltNamesTheKey) {
  const auto message = [](const SceneConfig& config) {
    const auto valid = validate(config);
    return valid ? std::string() : valid.error().message;
  };
  EXPECT_TRUE(message(loop_scene(24.0, 3.9)).starts_with("scene.loop.depth: expected at least"));
  SceneConfig wide = loop_scene(6.0, 20.0);
  wide.loop.width = 5.0;
  EXPECT_TRUE(message(wide).starts_with("scene.loop.length: expected at least"));
  SceneConfig ramp = loop_scene();
  ramp.ramp.grade = 0.1;
  EXPECT_TRUE(message(ramp).starts_with("scene.ramp: only a scene of kind corridor"));
  SceneConfig doors = loop_scene();
  doors.loop.doors.height = 3.0;
  EXPECT_TRUE(message(doors).starts_with("scene.loop.doors.height"));
}

}  // namespace
}  // namespace aims
