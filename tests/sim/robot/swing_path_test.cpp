// SPDX-License-Identifier: BSD-3-Clause
#include "sim/robot/swing_path.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "tests/support/walking.hpp"

namespace aims {
namespace {

const Swing kSwing = {
    .from = {0.1, 0.2, 0.022}, .to = {0.5, 0.25, 0.012}, .apex = 0.122, .time = 0.22};

SwingPathConfig ramped_path() {
  SwingPathConfig config;
  config.shape = SwingShape::kRamped;
  config.lift = 0.1;
  return config;
}

class SwingPathShape : public ::testing::TestWithParam<SwingShape> {
 protected:
  SwingPathShape() { config_.shape = GetParam(); }
  SwingPathConfig config_ = ramped_path();
};

TEST_P(SwingPathShape, LeadsFromLiftOffOverTheApexToTouchdown) {
  const SwingPoint start = swing_point(config_, kSwing, 0.0);
  EXPECT_LT((start.position - kSwing.from).norm(), 1e-12);
  EXPECT_LT(start.velocity.norm(), 1e-12) << "a foot leaves the ground at rest";
  EXPECT_LT((swing_point(config_, kSwing, 1.0).position - kSwing.to).norm(), 1e-12);
  EXPECT_NEAR(swing_point(config_, kSwing, 0.5).position.z(), kSwing.apex, 1e-12);
}

TEST_P(SwingPathShape, IsContinuousAndItsVelocityIsTheDerivative) {
  const double step = 1e-6;
  for (int i = 1; i < 1000; ++i) {
    const double s = 1e-3 * i;
    const SwingPoint before = swing_point(config_, kSwing, s - step);
    const SwingPoint after = swing_point(config_, kSwing, s + step);
    const SwingPoint now = swing_point(config_, kSwing, s);
    const Eigen::Vector3d rate = (after.position - before.position) / (2.0 * step * kSwing.time);
    EXPECT_LT((rate - now.velocity).norm(), 1e-3) << s;
    EXPECT_LT((after.velocity - before.velocity).norm(), 1e-3) << "no jump of the speed at " << s;
    EXPECT_LE(now.position.z(), kSwing.apex + 1e-12) << s;
    EXPECT_GE(now.position.z(), kSwing.to.z() - 1e-12) << s;
  }
}

INSTANTIATE_TEST_SUITE_P(Both, SwingPathShape,
                         ::testing::Values(SwingShape::kMinimumJerk, SwingShape::kRamped));

TEST(SwingPath, LandsWithTheConfiguredSpeeds) {
  const SwingPathConfig config = ramped_path();
  double fastest = 0.0;
  for (int i = 0; i <= 100; ++i) {
    fastest = std::max(fastest, swing_point(config, kSwing, 0.01 * i).velocity.x());
  }
  const SwingPoint end = swing_point(config, kSwing, 1.0);
  EXPECT_NEAR(end.velocity.z(), -config.descent, 1e-9);
  EXPECT_NEAR(end.velocity.x(), -config.retraction * fastest, 1e-9);
  SwingPathConfig smooth = config;
  smooth.shape = SwingShape::kMinimumJerk;
  EXPECT_LT(swing_point(smooth, kSwing, 1.0).velocity.norm(), 1e-9);
}

TEST(SwingPath, MovesForwardBeforeItRises) {
  const SwingPathConfig config = ramped_path();
  const SwingPoint point = swing_point(config, kSwing, config.lift);
  EXPECT_NEAR(point.position.z(), kSwing.from.z(), 1e-12);
  EXPECT_GT(point.position.x(), kSwing.from.x() + 0.005);
}

/// Mean velocity over the floor, x forward, of the feet in the last step before they touch [m/s].
Eigen::Vector3d landing_velocity(const GaitConfig& gait) {
  RouteConfig route;
  route.points = {{"a", 0.0, 0.0}, {"b", 4.0, 0.0}};
  route.stand_before = 0.5;
  route.speed = 0.93;
  const auto setup = testing::corridor_world(4.0, 0.7, 0.0);
  const auto walk = testing::walk(setup, route, gait);
  EXPECT_FALSE(walk.fell);
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  int landings = 0;
  for (std::size_t i = 2; i < walk.states.size(); ++i) {
    const RobotState& last = walk.states[i - 1];
    if (last.stamp < 3 * kSecond || last.stamp > 5 * kSecond) continue;
    for (int leg = 0; leg < kLegCount; ++leg) {
      const auto place = [&](const RobotState& state) {
        return Eigen::Vector3d(state.T_world_base *
                               foot_in_base(leg, joints_of(state.q, leg), setup.drawn));
      };
      const Eigen::Vector3d step = place(last) - place(walk.states[i - 2]);
      const bool lands = last.foot_load[leg] <= 0.0 && walk.states[i].foot_load[leg] > 0.0;
      if (!lands || step.z() > -5e-4) continue;  // a foot that bounces hardly moves
      sum += step / testing::kTimestep;
      ++landings;
    }
  }
  EXPECT_GT(landings, 10);
  return sum / landings;
}

TEST(SwingPath, ARetractedFootHardlyMovesForwardWhenItLands) {
  GaitConfig gait;
  gait.period = 0.502;
  gait.duty_factor = 0.5;
  gait.swing_stiffness = 105.0;
  gait.swing_damping = 9.0;
  const Eigen::Vector3d smooth = landing_velocity(gait);
  gait.swing = ramped_path();
  gait.swing.slow_down = 0.22;
  gait.swing.retraction = 0.45;
  const Eigen::Vector3d retracted = landing_velocity(gait);
  EXPECT_GT(smooth.x(), 0.5) << "it lands before its time, in full swing";
  EXPECT_LT(std::abs(retracted.x()), 0.2);
  EXPECT_LT(retracted.z(), -0.4) << "it comes down in motion";
}

}  // namespace
}  // namespace aims
