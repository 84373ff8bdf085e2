// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <utility>
#include <vector>

#include "sim/environment/scene_config.hpp"
#include "sim/environment/scene_mjcf.hpp"
#include "sim/robot/robot_config.hpp"
#include "sim/robot/truth.hpp"
#include "sim/robot/walker.hpp"
#include "sim/sensors/leg_odometry.hpp"

namespace aims::testing {

inline constexpr double kTimestep = 0.0025;  ///< [s]

/// The robot in a corridor whose route is `length` long [m].
inline WorldSetup corridor_world(double length, double friction, double bump_height,
                                 std::uint64_t seed = 1) {
  SceneConfig config;
  config.corridor.length = length;
  config.bumps.height = bump_height;
  const Scene scene = build_scene(config, seed);
  return {scene_mjcf(scene, robot_models().front().mjcf, MjcfPurpose::kPhysics).value(),
          height_field_data(scene.floor), kTimestep, friction};
}

/// From a to b along the corridor and back.
inline RouteConfig there_and_back(double length) {
  RouteConfig route;
  route.points = {{"a", 0.0, 0.0}, {"b", length, 0.0}, {"a", 0.0, 0.0}};
  route.stand_before = 0.5;
  route.stand_after = 0.5;
  return route;
}

/// The true motion of the body frame at the site `imu`.
inline TruthSample body_motion(const World& world) {
  const RobotState& state = world.state();
  const Pose T_base_body = world.T_base_site("imu");
  TruthSample sample;
  sample.stamp = state.stamp;
  sample.T_world_body = state.T_world_base * T_base_body;
  sample.velocity = state.velocity + state.T_world_base.rotation *
                                         state.angular_velocity.cross(T_base_body.translation);
  sample.angular_velocity = state.angular_velocity;
  return sample;
}

/// A walk that was recorded once so that many sensors can look at it.
struct Walk {
  std::vector<TruthSample> motion;  ///< of the body, at the physics rate
  std::vector<RobotState> states;   ///< at the physics rate
  std::vector<WaypointTime> waypoint_times;
  bool done = false;
  bool fell = false;
  bool touched_wall = false;
};

inline Walk walk(const WorldSetup& setup, const RouteConfig& route, const GaitConfig& gait = {}) {
  Walker walker = Walker::create(setup, gait, route).value();
  Walk walk;
  const Time limit = 2 * from_seconds(nominal_duration(route));
  while (!walker.route().done() && !walker.fallen() && walker.world().state().stamp < limit) {
    walk.motion.push_back(body_motion(walker.world()));
    walk.states.push_back(walker.world().state());
    walker.step();
    walk.touched_wall = walk.touched_wall || walker.world().state().touches_wall;
  }
  walk.waypoint_times = walker.route().waypoint_times();
  walk.done = walker.route().done();
  walk.fell = walker.fallen();
  return walk;
}

}  // namespace aims::testing
