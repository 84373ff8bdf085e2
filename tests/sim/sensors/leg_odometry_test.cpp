// SPDX-License-Identifier: BSD-3-Clause
#include "sim/sensors/leg_odometry.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "sim/robot/robot_geometry.hpp"
#include "tests/support/walking.hpp"

namespace aims {
namespace {

constexpr Duration kStep = 2'500'000;

/// Odometry whose only errors are those of its foot model and of the ground.
LegOdometryConfig perfect(FootModel model) {
  LegOdometryConfig config;
  config.foot_model = model;
  config.joint_angle_noise = config.joint_angle_offset = config.joint_rate_noise = 0.0;
  config.load_noise = 0.0;
  config.gyro_noise_density = config.gyro_bias = config.gyro_scale_error = 0.0;
  config.velocity_scale_error = 0.0;
  config.slip_rate = 0.0;
  return config;
}

const testing::Walk& recorded_walk() {
  static const testing::Walk walk = [] {
    RouteConfig route;
    route.points = {{"a", 0.0, 0.0}, {"b", 5.0, 0.0}};
    route.stand_before = 0.5;
    return testing::walk(testing::corridor_world(5.0, 0.8, 0.0), route);
  }();
  return walk;
}

std::vector<LegOdometrySample> measure(const LegOdometryConfig& config, std::uint64_t seed = 1) {
  LegOdometry odometry(config, kRobotGeometry, kStep, seed);
  std::vector<LegOdometrySample> samples;
  for (const RobotState& state : recorded_walk().states) {
    if (auto sample = odometry.sample(state)) samples.push_back(*sample);
  }
  return samples;
}

/// Distance reported over distance walked, less one.
double relative_error(const std::vector<LegOdometrySample>& samples) {
  const auto& states = recorded_walk().states;
  const double walked =
      (states.back().T_world_base.translation - states.front().T_world_base.translation)
          .head<2>()
          .norm();
  return samples.back().T_odom_base.translation.head<2>().norm() / walked - 1.0;
}

TEST(LegOdometry, RollingFeetMeasureTheDistanceWithinOnePercent) {
  EXPECT_LT(std::abs(relative_error(measure(perfect(FootModel::kRolling)))), 0.01);
}

TEST(LegOdometry, PointFeetReadShortByFootRadiusOverHipHeight) {
  const double expected = -kRobotGeometry.foot_radius / GaitConfig{}.body_height;
  EXPECT_NEAR(relative_error(measure(perfect(FootModel::kPoint))), expected, 0.015);
}

TEST(LegOdometry, AWrongScaleMultipliesWhatItReports) {
  LegOdometryConfig config = perfect(FootModel::kRolling);
  const double right = relative_error(measure(config));
  config.velocity_scale = 1.2;
  EXPECT_NEAR(1.0 + relative_error(measure(config)), 1.2 * (1.0 + right), 2e-3);
}

TEST(LegOdometry, ReportsTwoHundredTimesASecondWithEveryFieldFilled) {
  const auto samples = measure({});
  ASSERT_GT(samples.size(), 1000U);
  EXPECT_EQ(samples[1].stamp - samples[0].stamp, 5 * kMillisecond);
  const LegOdometrySample& sample = samples[600];
  EXPECT_GT(sample.linear_velocity.norm(), 0.2);
  EXPECT_TRUE(sample.contact[0] || sample.contact[1]);
  EXPECT_LT(sample.joint_position[2], -0.5);
  EXPECT_NE(sample.joint_velocity[2], 0.0);
}

TEST(LegOdometry, FindsTheTrueVelocityOnAverage) {
  const auto samples = measure(perfect(FootModel::kRolling));
  Eigen::Vector3d error = Eigen::Vector3d::Zero();
  int count = 0;
  for (const LegOdometrySample& sample : samples) {
    const RobotState& truth = recorded_walk().states[sample.stamp / kStep];
    error += sample.linear_velocity - truth.T_world_base.rotation.conjugate() * truth.velocity;
    ++count;
  }
  EXPECT_LT((error / count).norm(), 0.02);
}

TEST(LegOdometry, HeadingDriftsWithItsOwnGyro) {
  LegOdometryConfig config = perfect(FootModel::kRolling);
  config.gyro_bias = 0.01;
  const double drift = yaw_of(measure(config, 3).back().T_odom_base.rotation) -
                       yaw_of(recorded_walk().states.back().T_world_base.rotation);
  const double other = yaw_of(measure(config, 4).back().T_odom_base.rotation) -
                       yaw_of(recorded_walk().states.back().T_world_base.rotation);
  EXPECT_GT(std::abs(drift), 0.005);
  EXPECT_GT(std::abs(drift - other), 0.005);
}

TEST(LegOdometry, SlipBurstsLengthenTheMeasuredDistance) {
  LegOdometryConfig config = perfect(FootModel::kRolling);
  config.slip_rate = 2.0;
  EXPECT_GT(relative_error(measure(config)), 0.01);
}

TEST(LegOdometry, RefusesCrossedContactThresholds) {
  LegOdometryConfig config;
  config.contact_off = config.contact_on + 1.0;
  EXPECT_FALSE(validate(config, kStep));
}

}  // namespace
}  // namespace aims
