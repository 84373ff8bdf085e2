// SPDX-License-Identifier: BSD-3-Clause
#include "sim/robot/robot_geometry.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/support/walking.hpp"

namespace aims {
namespace {

TEST(LegLengths, WithoutErrorTheLegsAreTheDrawn) {
  EXPECT_EQ(built_legs(kRobotGeometry, {}, 7), kNominalLegs);
}

TEST(LegLengths, ErrorsHaveTheirStandardDeviationAndHalfOfItIsCommon) {
  double squares = 0.0;
  double products = 0.0;
  constexpr int kRuns = 500;
  for (int seed = 1; seed <= kRuns; ++seed) {
    const LegGeometries legs = built_legs(kRobotGeometry, {.link_length = 0.01}, seed);
    const double front = legs[0].calf / kRobotGeometry.calf - 1.0;
    const double rear = legs[3].calf / kRobotGeometry.calf - 1.0;
    squares += 0.5 * (front * front + rear * rear);
    products += front * rear;
    EXPECT_EQ(legs[1].foot_radius, kRobotGeometry.foot_radius);
    EXPECT_NE(legs[0].thigh, legs[1].thigh);
  }
  EXPECT_NEAR(std::sqrt(squares / kRuns), 0.01, 0.001) << "seeds 1 to 500";
  EXPECT_NEAR(products / squares, 0.5, 0.12) << "seeds 1 to 500";
}

/// Length that the nominal kinematics measure with those legs, over the length walked, less one.
double short_reading(const LegGeometry& built) {
  WorldSetup setup = testing::corridor_world(4.0, 0.8, 0.0);
  setup.legs = {built, built, built, built};
  RouteConfig route;
  route.points = {{"a", 0.0, 0.0}, {"b", 4.0, 0.0}};
  const testing::Walk walk = testing::walk(setup, route);
  LegOdometryConfig config;
  config.foot_model = FootModel::kRolling;
  config.joint_angle_noise = config.joint_angle_offset = config.joint_rate_noise = 0.0;
  config.gyro_noise_density = config.gyro_bias = config.gyro_scale_error = 0.0;
  config.velocity_scale_error = config.slip_rate = 0.0;
  LegOdometry odometry(config, kRobotGeometry, from_seconds(testing::kTimestep), 1);
  Eigen::Vector3d end = Eigen::Vector3d::Zero();
  for (const RobotState& state : walk.states) {
    if (const auto sample = odometry.sample(state)) end = sample->T_odom_base.translation;
  }
  const Eigen::Vector3d walked =
      walk.states.back().T_world_base.translation - walk.states.front().T_world_base.translation;
  return end.head<2>().norm() / walked.head<2>().norm() - 1.0;
}

LegGeometry longer(double part) {
  LegGeometry leg = kRobotGeometry;
  leg.thigh *= 1.0 + part;
  leg.calf *= 1.0 + part;
  return leg;
}

/// The same angles carry longer legs further.
TEST(LegLengths, KinematicsOfLegsThatAreLongerInTruthReadShort) {
  const double nominal = short_reading(kRobotGeometry);
  EXPECT_NEAR(short_reading(longer(0.04)) - nominal, -0.04, 0.01);
  EXPECT_NEAR(short_reading(longer(-0.04)) - nominal, 0.04, 0.01);
}

TEST(LegLengths, FeetAreAsMuchLargerAsTheDifferenceSays) {
  for (const LegGeometry& leg : built_legs(kRobotGeometry, {.foot_radius = 0.002}, 7)) {
    EXPECT_DOUBLE_EQ(leg.foot_radius, kRobotGeometry.foot_radius + 0.002);
    EXPECT_EQ(leg.calf, kRobotGeometry.calf);
  }
}

/// A foot rolls by its radius per radian of the calf: 5 mm of some 0.28 m of leg.
TEST(LegLengths, KinematicsOfFeetThatAreLargerInTruthReadShort) {
  LegGeometry large = kRobotGeometry;
  large.foot_radius += 0.005;
  EXPECT_NEAR(short_reading(large) - short_reading(kRobotGeometry), -0.018, 0.006);
}

}  // namespace
}  // namespace aims
