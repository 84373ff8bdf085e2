// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include "sim/robot/scene_route.hpp"
#include "tests/support/walking.hpp"

namespace aims {
namespace {

/// Out and back through two bends.
testing::Walk walk_through(double angle_deg, double width, double speed) {
  SceneConfig config;
  config.corridor.length = 12.0;
  config.corridor.width = width;
  config.corridor.bends = {{0.33, angle_deg, Side::kLeft}, {0.67, angle_deg, Side::kRight}};
  const Scene scene = build_scene(config, 1);
  const WorldSetup setup = {
      scene_mjcf(scene, robot_models().front().mjcf, MjcfPurpose::kPhysics).value(),
      height_field_data(scene.floor), testing::kTimestep, 0.7};
  RouteConfig route;
  route.follow_scene = true;
  route.speed = speed;
  route.stand_before = 0.5;
  route.stand_after = 0.5;
  return testing::walk(setup, route_in(config, route));
}

TEST(BendWalk, PassesTheSharpestBendsWithoutTouchingAWall) {
  for (const double speed : {0.3, 0.7, 1.0}) {
    for (const double width : {1.2, 2.2}) {
      const testing::Walk walk = walk_through(90.0, width, speed);
      EXPECT_TRUE(walk.done) << speed << " m/s, " << width << " m";
      EXPECT_FALSE(walk.fell) << speed << " m/s, " << width << " m";
      EXPECT_FALSE(walk.touched_wall) << speed << " m/s, " << width << " m";
      ASSERT_EQ(walk.waypoint_times.size(), 3U);
    }
  }
}

}  // namespace
}  // namespace aims
