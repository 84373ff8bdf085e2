// SPDX-License-Identifier: BSD-3-Clause
// Drift of leg odometry at the level `field`, where it must arise from contact timing, compliance,
// geometry and the ground alone.
#include <gtest/gtest.h>

#include <cmath>

#include "tests/sim/sensors/leg_drift.hpp"

namespace aims {
namespace {

using testing::config_at;
using testing::drift_of;
using testing::drift_walk;
using testing::LegDrift;
using testing::without_errors;

constexpr double kFriction = 0.7;

/// Mean drift out and back of the robot of that seed at the level `field`.
LegDrift field_drift(FootModel model, std::uint64_t seed, double friction = kFriction) {
  SimulationConfig config = config_at(SensorLevel::kField);
  config.leg_odometry.foot_model = model;
  return drift_of(drift_walk(config, friction, seed), config.leg_odometry, seed);
}

TEST(LegDrift, NeitherDatasheetNorFieldInjectsScaleOrSlip) {
  for (const SensorLevel level : {SensorLevel::kDatasheet, SensorLevel::kField}) {
    const LegOdometryConfig legs = config_at(level).leg_odometry;
    EXPECT_EQ(legs.velocity_scale, 1.0);
    EXPECT_EQ(legs.velocity_scale_error, 0.0);
    EXPECT_EQ(legs.slip_rate, 0.0);
  }
}

TEST(LegDrift, RollingFeetOnGoodGroundWithoutErrorsReadTheDistance) {
  const SimulationConfig config = config_at(SensorLevel::kIdeal);
  LegOdometryConfig legs = without_errors(config.leg_odometry);
  legs.foot_model = FootModel::kRolling;
  const LegDrift drift = drift_of(drift_walk(config, 1.0, 1), legs, 1);
  EXPECT_LT(std::abs(drift.out), 0.01);
  EXPECT_LT(std::abs(drift.back), 0.01);
}

/// Seeds that no figure of the preset was chosen on.
TEST(LegDrift, PointFeetOfTheFieldReadTwelveToTwentyFourPercentShort) {
  for (const std::uint64_t seed : {21, 22}) {
    const LegDrift drift = field_drift(FootModel::kPoint, seed);
    for (const double way : {drift.out, drift.back}) {
      EXPECT_LT(way, -0.12) << "seed " << seed;
      EXPECT_GT(way, -0.24) << "seed " << seed;
    }
  }
}

/// A rolling foot accounts for its radius over the height of the hip, about 7 %, and no more: less
/// where feet that swing count as standing, whose calves turn back.
TEST(LegDrift, RollingFeetOfTheFieldReadLessShortButShort) {
  const LegDrift point = field_drift(FootModel::kPoint, 21);
  const LegDrift rolling = field_drift(FootModel::kRolling, 21);
  const double rolled = rolling.mean() - point.mean();
  EXPECT_LT(rolled, kRobotGeometry.foot_radius / GaitConfig{}.body_height + 0.015);
  EXPECT_GT(rolled, 0.03);
  EXPECT_LT(rolling.mean(), -0.02);
}

TEST(LegDrift, ChangesWithTheContactThreshold) {
  const SimulationConfig config = config_at(SensorLevel::kField);
  const testing::Walk walk = drift_walk(config, kFriction, 21);
  LegOdometryConfig low = config.leg_odometry;
  low.contact_on = 10.0;
  low.contact_off = 5.0;
  LegOdometryConfig high = config.leg_odometry;
  high.contact_on = 30.0;
  high.contact_off = 20.0;
  EXPECT_LT(drift_of(walk, low, 21).mean(), drift_of(walk, high, 21).mean() - 0.01);
}

/// A robot that turns at the corners of a square, as the Go1 did.
TEST(LegDrift, ASquareOfPointFeetIsTwelveToTwentyFourPercentShort) {
  SimulationConfig config = config_at(SensorLevel::kField);
  const testing::Walk walk = testing::square_walk(config, kFriction, 23);
  ASSERT_TRUE(walk.done);
  const double point = testing::path_error(walk, config, 23);
  EXPECT_LT(point, -0.12);
  EXPECT_GT(point, -0.24);
  config.leg_odometry.foot_model = FootModel::kRolling;
  EXPECT_GT(testing::path_error(walk, config, 23), point + 0.03);
}

TEST(LegDrift, DiffersByRobotAndByGround) {
  const double one = field_drift(FootModel::kRolling, 21).mean();
  EXPECT_GT(std::abs(one - field_drift(FootModel::kRolling, 22).mean()), 1e-3);
  EXPECT_LT(field_drift(FootModel::kRolling, 21, 0.4).mean(), one - 0.01);
}

}  // namespace
}  // namespace aims
