// SPDX-License-Identifier: BSD-3-Clause
#include "sim/robot/world.hpp"

#include <gtest/gtest.h>

#include <numeric>

#include "sim/robot/gait.hpp"
#include "sim/robot/robot_geometry.hpp"
#include "tests/support/walking.hpp"

namespace aims {
namespace {

using testing::corridor_world;
using testing::kTimestep;

/// The robot stands for that long under its controller.
World standing_world(double seconds) {
  World world = World::create(corridor_world(10.0, 0.7, 0.0)).value();
  GaitController gait({}, world.body(), kTimestep);
  for (int i = 0; i < seconds / kTimestep; ++i) world.step(gait.torques(world.state(), {}));
  return world;
}

TEST(World, RobotWeighsTwelveToThirteenKilograms) {
  const World world = World::create(corridor_world(10.0, 0.7, 0.0)).value();
  EXPECT_GT(world.body().mass, 12.0);
  EXPECT_LT(world.body().mass, 13.0);
}

TEST(World, StandingFeetCarryTheWeightAndRestOnTheFloor) {
  const World world = standing_world(2.0);
  const RobotState& state = world.state();
  const double load = std::accumulate(state.foot_load.begin(), state.foot_load.end(), 0.0);
  EXPECT_NEAR(load, world.body().mass * 9.81, 1.0);
  // Kinematics here and in the model agree: every foot sphere touches the floor.
  for (int leg = 0; leg < kLegCount; ++leg) {
    const Eigen::Vector3d foot =
        state.T_world_base * foot_in_base(leg, joints_of(state.q, leg), kRobotGeometry);
    EXPECT_NEAR(foot.z(), kRobotGeometry.foot_radius, 1.5e-3) << kLegNames[leg];
  }
  EXPECT_LT(state.velocity.norm(), 0.01);
  for (const double slip : world.slip_speed()) EXPECT_LT(slip, 0.01);
}

/// Newton: a robot at rest is pushed back by the floor as hard as it is pushed.
TEST(World, TheFloorsForceOnTheFeetOpposesWeightAndPush) {
  World world = World::create(corridor_world(10.0, 0.7, 0.0)).value();
  GaitController gait({}, world.body(), kTimestep);
  const Eigen::Vector3d push(12.0, -8.0, 0.0);
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  constexpr int kSettling = 1200;
  constexpr int kAveraged = 400;
  for (int i = 0; i < kSettling + kAveraged; ++i) {
    world.push(push);
    world.step(gait.torques(world.state(), {}));
    if (i < kSettling) continue;
    for (const Eigen::Vector3d& force : world.state().foot_force) sum += force / kAveraged;
  }
  const Eigen::Vector3d expected = Eigen::Vector3d(0.0, 0.0, world.body().mass * 9.81) - push;
  EXPECT_LT((sum - expected).norm(), 1.0) << sum.transpose();
}

TEST(World, LongerLegsReachTheFloorWithTheirOwnKinematics) {
  WorldSetup setup = corridor_world(10.0, 0.7, 0.0);
  for (LegGeometry& leg : setup.legs) {
    leg.thigh *= 1.03;
    leg.calf *= 0.98;
  }
  World world = World::create(setup).value();
  GaitController gait({}, world.body(), kTimestep);
  for (int i = 0; i < 800; ++i) world.step(gait.torques(world.state(), {}));
  const RobotState& state = world.state();
  for (int leg = 0; leg < kLegCount; ++leg) {
    const Eigen::Vector3d foot =
        state.T_world_base * foot_in_base(leg, joints_of(state.q, leg), setup.legs[leg]);
    EXPECT_NEAR(foot.z(), kRobotGeometry.foot_radius, 1.5e-3) << kLegNames[leg];
  }
  for (const double slip : world.slip_speed()) EXPECT_LT(slip, 0.01);
}

/// Hips apart, longer legs and rounder feet than the model's: the feet stand where the kinematics
/// of these legs have them.
TEST(World, TakesAllDimensionsOfTheLegs) {
  WorldSetup setup = corridor_world(10.0, 0.7, 0.0);
  setup.drawn = {.hip_x = 0.22,
                 .hip_y = 0.06,
                 .abduction = 0.09,
                 .thigh = 0.23,
                 .calf = 0.225,
                 .foot_radius = 0.03};
  setup.legs.fill(setup.drawn);
  World world = World::create(setup).value();
  EXPECT_EQ(world.body().legs, setup.drawn);
  GaitController gait({}, world.body(), kTimestep);
  for (int i = 0; i < 800; ++i) world.step(gait.torques(world.state(), {}));
  const RobotState& state = world.state();
  for (int leg = 0; leg < kLegCount; ++leg) {
    const Eigen::Vector3d foot =
        state.T_world_base * foot_in_base(leg, joints_of(state.q, leg), setup.drawn);
    EXPECT_NEAR(foot.z(), setup.drawn.foot_radius, 1.5e-3) << kLegNames[leg];
  }
  EXPECT_NEAR(state.T_world_base.translation.z(), GaitConfig().body_height, 0.01);
}

TEST(World, SensorsSitLevelOnTheRearOfTheTrunk) {
  const World world = World::create(corridor_world(10.0, 0.7, 0.0)).value();
  for (const char* site : {"imu", "lidar"}) {
    const Pose T_base_site = world.T_base_site(site);
    EXPECT_LT(T_base_site.translation.x(), -0.1) << site;
    EXPECT_TRUE(T_base_site.rotation.isApprox(Eigen::Quaterniond::Identity())) << site;
  }
  EXPECT_GT(world.T_base_site("lidar").translation.z(), 0.1);
}

TEST(World, NoticesTheWallThatTheRobotIsPlacedIn) {
  World world = World::create(corridor_world(10.0, 0.7, 0.0)).value();
  world.place(2.0, 0.0, 0.0);
  EXPECT_FALSE(world.robot_inside_solid());
  world.place(2.0, 1.05, 0.0);
  EXPECT_TRUE(world.robot_inside_solid());
}

TEST(World, RefusesAModelWithoutAQuadruped) {
  WorldSetup empty;
  empty.mjcf = "<mujoco/>";
  EXPECT_FALSE(World::create(empty));
  empty.mjcf = "not a model";
  EXPECT_FALSE(World::create(empty));
  WorldSetup setup = corridor_world(10.0, 0.7, 0.0);
  setup.heights = {0.0F, 1.0F};
  EXPECT_FALSE(World::create(setup));
}

TEST(World, StepsTheSameEveryTime) {
  const World once = standing_world(0.5);
  const World again = standing_world(0.5);
  EXPECT_EQ(once.qpos(), again.qpos());
}

}  // namespace
}  // namespace aims
