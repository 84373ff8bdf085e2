// SPDX-License-Identifier: BSD-3-Clause
#include "sim/robot/walk_monitor.hpp"

#include <gtest/gtest.h>

#include <set>

#include "sim/simulation.hpp"
#include "tests/support/walking.hpp"

namespace aims {
namespace {

using testing::kTimestep;

constexpr double kLimit = 900.0;  ///< [s]

/// A short corridor and a robot in it.
struct Walked {
  WalkOutcome outcome;
  double seconds = 0.0;
  Pose T_world_base;
};

Walked watch(const SceneConfig& config, const RouteConfig& route, const PushConfig& push = {},
             double limit = kLimit) {
  const Scene scene = build_scene(config, 1);
  const WorldSetup setup = {
      scene_mjcf(scene, robot_models().front().mjcf, MjcfPurpose::kPhysics).value(),
      height_field_data(scene.floor), kTimestep, config.floor_friction};
  Walker walker = Walker::create(setup, {}, route).value();
  WalkMonitor monitor(route, GaitConfig{}.period, limit);
  const Pushes pushes(push, 1);
  while (!monitor.ended()) {
    walker.world().push(pushes.force_at(walker.world().state().stamp));
    walker.step();
    monitor.update(walker, scene.floor);
  }
  const RobotState& state = walker.world().state();
  return {monitor.outcome(), to_seconds(state.stamp), state.T_world_base};
}

SceneConfig corridor(double length) {
  SceneConfig config;
  config.corridor.length = length;
  config.corridor.margin = 1.0;
  return config;
}

RouteConfig straight(double length) {
  RouteConfig route;
  route.points = {{"a", 0.0, 0.0}, {"b", length, 0.0}};
  route.stand_before = 0.5;
  route.stand_after = 0.5;
  return route;
}

TEST(WalkMonitor, ARouteThatIsWalkedIsDone) {
  const Walked walked = watch(corridor(2.0), straight(2.0));
  EXPECT_EQ(walked.outcome.end, WalkEnd::kRouteDone);
  EXPECT_FALSE(walked.outcome.touched_wall);
  EXPECT_EQ(walked.outcome.wall_contact_fraction, 0.0);
}

TEST(WalkMonitor, ATargetBehindAWallEndsTheWalkForNoProgress) {
  const RouteConfig route = straight(8.0);  // the corridor ends at 3 m
  const Walked walked = watch(corridor(2.0), route);
  EXPECT_EQ(walked.outcome.end, WalkEnd::kNoProgress);
  EXPECT_TRUE(walked.outcome.touched_wall);
  EXPECT_GT(walked.outcome.wall_contact_fraction, 0.5);
  EXPECT_LT(walked.outcome.wall_contact_fraction, 1.0) << "the way to the wall was free";
  EXPECT_LT(walked.seconds, patience(route) + 10.0);
}

TEST(WalkMonitor, LongPausesAndASlowWalkAreNoLackOfProgress) {
  RouteConfig route = straight(1.2);
  route.points.push_back({"c", 0.6, 0.0});
  route.speed = 0.1;
  route.turn_rate = 0.3;
  route.stand_before = 1.2 * patience(route);
  route.stand_at_points = 1.2 * patience(route);
  const Walked walked = watch(corridor(2.0), route);
  EXPECT_EQ(walked.outcome.end, WalkEnd::kRouteDone);
  EXPECT_LT(walked.seconds, kLimit);
}

TEST(WalkMonitor, PushesOnTheWayAreNoLackOfProgress) {
  const PushConfig push = {.count = 10, .force = 60.0, .duration = 0.2, .start = 1.0, .end = 11.0};
  EXPECT_EQ(watch(corridor(6.0), straight(6.0), push).outcome.end, WalkEnd::kRouteDone);
}

TEST(WalkMonitor, APushedOverRobotFell) {
  const PushConfig push = {.count = 3, .force = 500.0, .duration = 0.5};
  const Walked walked = watch(corridor(2.0), straight(2.0), push);
  EXPECT_EQ(walked.outcome.end, WalkEnd::kFell);
  EXPECT_LT(walked.seconds, 6.0);
}

TEST(WalkMonitor, ARobotThatWalksOutOfAnOpenEndLeftTheScene) {
  SceneConfig open = corridor(2.0);
  open.corridor.end_walls = EndWalls::kNone;
  const Walked walked = watch(open, straight(8.0));
  EXPECT_EQ(walked.outcome.end, WalkEnd::kLeftScene);
  EXPECT_GT(walked.T_world_base.translation.x(), 3.0);
  EXPECT_LT(walked.T_world_base.translation.x(), 3.5);
}

TEST(WalkMonitor, EndsAtTheTimeLimit) {
  const Walked walked = watch(corridor(2.0), straight(2.0), {}, 1.5);
  EXPECT_EQ(walked.outcome.end, WalkEnd::kTimeLimit);
  EXPECT_EQ(walked.seconds, 1.5);
}

TEST(WalkMonitor, EveryEndHasItsOwnName) {
  std::set<std::string_view> names;
  for (int i = 0; i <= static_cast<int>(WalkEnd::kUnstablePhysics); ++i) {
    names.insert(name_of(static_cast<WalkEnd>(i)));
  }
  EXPECT_EQ(names.size(), 7U);
  EXPECT_TRUE(names.contains("no_progress"));
}

TEST(Simulation, AFallBeforeTheRecordingStartsEndsItAtOnce) {
  SimulationConfig config;
  config.scene.corridor.length = 10.0;
  config.route = straight(2.0);
  config.push = {.count = 3, .force = 500.0, .duration = 0.5};
  config.recording_start = 20.0;
  Simulation simulation = Simulation::create(config, 1).value();
  std::vector<Delivery> deliveries;
  EXPECT_FALSE(simulation.advance(kSecond, deliveries));
  EXPECT_EQ(simulation.truth().walk.end, WalkEnd::kFell);
  EXPECT_LT(to_seconds(simulation.now()), 6.0);
}

}  // namespace
}  // namespace aims
