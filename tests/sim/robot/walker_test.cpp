// SPDX-License-Identifier: BSD-3-Clause
#include "sim/robot/walker.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/support/walking.hpp"

namespace aims {
namespace {

using testing::corridor_world;
using testing::kTimestep;
using testing::there_and_back;
using testing::Walk;

void expect_good_walk(double friction, double bump_height) {
  const Walk walk = testing::walk(corridor_world(4.0, friction, bump_height), there_and_back(4.0));
  EXPECT_TRUE(walk.done);
  EXPECT_FALSE(walk.fell);
  EXPECT_FALSE(walk.touched_wall);
  ASSERT_EQ(walk.waypoint_times.size(), 3U);
  for (const RobotState& state : walk.states) {
    ASSERT_LT(std::abs(state.T_world_base.translation.y()), 0.15);
  }
  const Pose& last = walk.states.back().T_world_base;
  EXPECT_LT(last.translation.head<2>().norm(), 0.1);
  EXPECT_GT(std::abs(yaw_of(last.rotation)), 3.0);
}

TEST(Walker, WalksTurnsAndReturnsOnSlipperyFloor) { expect_good_walk(0.4, 0.0); }
TEST(Walker, WalksTurnsAndReturnsOnBumps) { expect_good_walk(0.7, 0.02); }
TEST(Walker, WalksTurnsAndReturnsOnGrippyFloor) { expect_good_walk(1.0, 0.01); }

TEST(Walker, KeepsItsSpeed) {
  RouteConfig route;
  route.points = {{"a", 0.0, 0.0}, {"b", 6.0, 0.0}};
  const Walk walk = testing::walk(corridor_world(6.0, 0.7, 0.0), route);
  ASSERT_TRUE(walk.done);
  const auto index = [](double t) { return static_cast<std::size_t>(t / kTimestep); };
  const double from = walk.states[index(8.0)].T_world_base.translation.x();
  const double to = walk.states[index(12.0)].T_world_base.translation.x();
  EXPECT_NEAR((to - from) / 4.0, route.speed, 0.03);
}

TEST(Walker, SurvivesASidewaysPush) {
  Walker walker = Walker::create(corridor_world(6.0, 0.7, 0.0), {}, there_and_back(6.0)).value();
  while (!walker.route().done() && !walker.fallen()) {
    const double t = to_seconds(walker.world().state().stamp);
    const bool pushed = t > 4.0 && t < 4.2;
    walker.world().push({0.0, pushed ? 60.0 : 0.0, 0.0});
    walker.step();
  }
  EXPECT_FALSE(walker.fallen());
}

}  // namespace
}  // namespace aims
