// SPDX-License-Identifier: BSD-3-Clause
#include "sim/robot/trunk_motion.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "tests/support/walking.hpp"

namespace aims {
namespace {

constexpr double kDuty = 0.58;
constexpr double kPeriod = 0.433;  ///< [s]

TrunkReference at(double phase) { return trunk_reference({}, phase, kDuty, kPeriod); }

TEST(TrunkMotion, RatesAndAccelerationsAreTheDerivatives) {
  const double step = 1e-5;
  const double time = 2.0 * step * kPeriod;
  for (const double phase : {0.0, 0.13, 0.4, 0.77, 0.98}) {
    const TrunkReference before = at(phase - step);
    const TrunkReference after = at(phase + step);
    const TrunkReference now = at(phase);
    EXPECT_NEAR((after.height - before.height) / time, now.velocity, 1e-6);
    EXPECT_NEAR((after.velocity - before.velocity) / time, now.acceleration, 1e-5);
    EXPECT_LT(((after.tilt - before.tilt) / time - now.rate).norm(), 1e-5);
    EXPECT_LT(((after.rate - before.rate) / time - now.angular_acceleration).norm(), 1e-4);
  }
}

TEST(TrunkMotion, IsLowestAndPushesHardestInTheMiddleOfEachStance) {
  const TrunkMotionConfig config;
  const double speed = 4.0 * M_PI / kPeriod;
  for (const double phase : {0.5 * kDuty, 0.5 * kDuty + 0.5}) {
    EXPECT_NEAR(at(phase).height, -config.bounce, 1e-12);
    EXPECT_NEAR(at(phase).acceleration, config.bounce * speed * speed, 1e-9);
    EXPECT_NEAR(at(phase).tilt.x(), 0.0, 1e-12);
  }
  EXPECT_GT(at(0.5 * kDuty).rate.x() * -at(0.5 * kDuty + 0.5).rate.x(), 0.0)
      << "rolls once per stride";
}

TEST(TrunkMotion, AVaultIsHighestInTheMiddleOfEachStance) {
  TrunkMotionConfig config;
  config.bounce = 0.0;
  config.vault = 0.006;
  const double speed = 4.0 * M_PI / kPeriod;
  for (const double phase : {0.5 * kDuty, 0.5 * kDuty + 0.5}) {
    const TrunkReference highest = trunk_reference(config, phase, kDuty, kPeriod);
    EXPECT_NEAR(highest.height, 0.006, 1e-12);
    EXPECT_NEAR(highest.acceleration, -0.006 * speed * speed, 1e-9) << "the feet carry less";
    EXPECT_NEAR(trunk_reference(config, phase + 0.25, kDuty, kPeriod).height, -0.006, 1e-12);
  }
}

/// Range of the trunk's height over a steady trot [m].
double height_range(const GaitConfig& gait) {
  RouteConfig route;
  route.points = {{"a", 0.0, 0.0}, {"b", 4.0, 0.0}};
  route.stand_before = 0.5;
  const auto walk = testing::walk(testing::corridor_world(4.0, 0.7, 0.0), route, gait);
  EXPECT_FALSE(walk.fell);
  double lowest = 1.0;
  double highest = 0.0;
  for (const RobotState& state : walk.states) {
    if (state.stamp < 3 * kSecond || state.stamp > 5 * kSecond) continue;
    lowest = std::min(lowest, state.T_world_base.translation.z());
    highest = std::max(highest, state.T_world_base.translation.z());
  }
  return highest - lowest;
}

TEST(TrunkMotion, TheRobotVaultsOverItsLegs) {
  GaitConfig level;
  level.trunk.bounce = 0.0;
  GaitConfig vaulting = level;
  vaulting.trunk.vault = 0.006;
  const double with = height_range(vaulting);
  EXPECT_LT(height_range(level), 0.005);
  EXPECT_GT(with, 0.009);
  EXPECT_LT(with, 0.018);
}

TEST(TrunkMotion, IsNoneWhileTheRobotStands) {
  RouteConfig route = testing::there_and_back(2.0);
  route.stand_before = 4.0;
  GaitConfig still;
  still.trunk = {0.0, 0.0, 0.0};
  const auto setup = testing::corridor_world(2.0, 0.7, 0.0);
  Walker moving = Walker::create(setup, {}, route).value();
  Walker level = Walker::create(setup, still, route).value();
  while (moving.world().state().stamp < 3 * kSecond) {
    moving.step();
    level.step();
  }
  EXPECT_EQ(moving.world().qpos(), level.world().qpos());
  while (moving.world().state().stamp < 6 * kSecond) {
    moving.step();
    level.step();
  }
  EXPECT_NE(moving.world().qpos(), level.world().qpos());
}

}  // namespace
}  // namespace aims
