// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "core/leg_kinematics.hpp"
#include "sim/robot/robot_geometry.hpp"
#include "sim/simulation.hpp"
#include "tests/support/walking.hpp"

namespace aims {
namespace {

SceneConfig ramp_scene(double grade) {
  SceneConfig config;
  config.corridor.length = 6.0;
  config.ramp = {.start = 1.5, .length = 3.0, .grade = grade};
  return config;
}

TEST(RampWalk, ClimbsAndDescendsTenPercentWithItsFeetOnTheFloor) {
  const Scene scene = build_scene(ramp_scene(0.1), 1);
  const WorldSetup setup = {
      scene_mjcf(scene, robot_models().front().mjcf, MjcfPurpose::kPhysics).value(),
      height_field_data(scene.floor), testing::kTimestep, 0.7};
  const testing::Walk walk = testing::walk(setup, testing::there_and_back(6.0));
  EXPECT_TRUE(walk.done);
  EXPECT_FALSE(walk.fell);
  EXPECT_FALSE(walk.touched_wall);
  double highest = 0.0;
  for (const RobotState& state : walk.states) {
    highest = std::max(highest, state.T_world_base.translation.z());
    for (int leg = 0; leg < kLegCount; ++leg) {
      if (state.foot_load[leg] < 30.0) continue;
      const Eigen::Vector3d q = joints_of(state.q, leg);
      const Eigen::Vector3d foot = state.T_world_base * foot_in_base(leg, q, kRobotGeometry);
      const double ground = floor_height(scene.floor, foot.x(), foot.y());
      // A loaded foot's sphere rests on the floor, within what the contact gives way.
      ASSERT_NEAR(foot.z() - ground, kRobotGeometry.foot_radius, 0.01) << state.stamp;
    }
  }
  EXPECT_NEAR(highest, 0.3 + 0.29, 0.03) << "trunk over the upper floor";
  EXPECT_NEAR(walk.states.back().T_world_base.translation.z(), 0.29, 0.02);
}

TEST(RampWalk, ARouteMayStartOnTheUpperFloor) {
  SimulationConfig config;
  config.scene = ramp_scene(0.25);
  config.route.points = {{"a", 6.0, 0.0}, {"b", 5.0, 0.0}};
  auto simulation = Simulation::create(config, 1);
  ASSERT_TRUE(simulation) << simulation.error().message;
  EXPECT_NEAR(simulation->truth().samples.front().T_world_body.translation.z(), 0.75 + 0.3, 0.05);
}

TEST(RampWalk, RoutePointsAreCheckedAgainstSolidsOnTheUpperFloor) {
  SimulationConfig config;
  config.scene = ramp_scene(0.25);
  config.scene.corridor.clutter.density = 2.0;
  // Loose objects on the upper floor begin at 0.75 m: a point at its own height, 0.29 m above the
  // floor, is inside of one, while 0.29 m above z = 0 there would be nothing.
  const Scene scene = build_scene(config.scene, 1);
  const auto object = std::find_if(scene.solids.begin(), scene.solids.end(), [](const Solid& s) {
    const Eigen::Vector3d& at = s.T_world_solid.translation;
    return s.visible && !s.collides && !s.roof && at.x() > 5.0 && at.x() < 8.0 &&
           std::abs(at.z() - s.half_extents.z() - 0.75) < 1e-9 && s.half_extents.z() < 0.8;
  });
  ASSERT_NE(object, scene.solids.end());
  const Eigen::Vector3d at = object->T_world_solid.translation;
  config.route.points = {{"a", 0.0, 0.0}, {"b", at.x(), at.y()}};
  const auto blocked = Simulation::create(config, 1);
  ASSERT_FALSE(blocked);
  EXPECT_NE(blocked.error().message.find("route.points.1"), std::string::npos);
}

}  // namespace
}  // namespace aims
