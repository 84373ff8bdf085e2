// SPDX-License-Identifier: BSD-3-Clause
#include "estimator/filter/outage.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace aims {
namespace {

using E = ErrorState;

Belief walking() {
  Belief belief;
  belief.state.velocity = {0.7, 0.0, 0.0};
  belief.covariance = 1e-6 * ErrorMatrix::Identity();
  return belief;
}

double sigma(const Belief& belief, int index) { return std::sqrt(belief.covariance(index, index)); }

TEST(Outage, OnlyLongSegmentsWithoutSamplesCount) {
  InertialSegment segment;
  segment.end = from_seconds(2.0 * kLongestBridge);
  EXPECT_FALSE(is_outage(segment));
  segment.measured = false;
  EXPECT_TRUE(is_outage(segment));
  segment.end = from_seconds(0.9 * kLongestBridge);
  EXPECT_FALSE(is_outage(segment));
}

TEST(Outage, AWalkGoesOnForAWhileAndStops) {
  EXPECT_NEAR(after_outage(walking(), 0.5).state.position.x(), 0.35, 0.04);
  const Belief late = after_outage(walking(), 60.0);
  EXPECT_LT(late.state.position.x(), 0.7 * 3.1);
  EXPECT_LT(late.state.velocity.norm(), 1e-6);
}

TEST(Outage, WhereARobotMayHaveWalkedAndTurnedIsWithinThreeDeviations) {
  for (const double seconds : {0.5, 1.0, 3.0, 10.0}) {
    const Belief after = after_outage(walking(), seconds);
    const double stopped = after.state.position.x();
    const double turned_back = after.state.position.x() + 0.7 * seconds;
    const double walked_on = 0.7 * seconds - after.state.position.x();
    const double position = sigma(after, E::kPosition.offset);
    EXPECT_LT(stopped, 3.0 * position) << seconds;
    EXPECT_LT(walked_on, 3.0 * position) << seconds;
    EXPECT_LT(turned_back, 3.0 * position) << seconds;
    EXPECT_NEAR(sigma(after, E::kRotation.offset), 0.1, 0.01) << "tilt";
    const Eigen::LLT<ErrorMatrix> factor(after.covariance);
    EXPECT_EQ(factor.info(), Eigen::Success) << seconds;
  }
}

TEST(Outage, TheHeadingIsUnknownAboutTheVerticalAlone) {
  Belief belief = walking();
  belief.state.rotation = Eigen::AngleAxisd(0.5 * std::numbers::pi, Eigen::Vector3d::UnitY());
  const Belief after = with_unmeasured_heading(belief, 0.0, 1.0);  // x of the body points down
  EXPECT_GT(3.0 * sigma(after, E::kRotation.offset), heading_reach(1.0));
  EXPECT_NEAR(sigma(after, E::kRotation.offset + 1), 1e-3, 1e-6);
  EXPECT_NEAR(sigma(after, E::kRotation.offset + 2), 1e-3, 1e-6);
}

TEST(Outage, TheHeadingIsAsUnknownByManyStepsAsByOne) {
  Belief steps = walking();
  for (int i = 0; i < 40; ++i) steps = with_unmeasured_heading(steps, 0.1 * i, 0.1 * (i + 1));
  const Belief once = with_unmeasured_heading(walking(), 0.0, 4.0);
  EXPECT_LT((steps.covariance - once.covariance).norm(), 1e-12);
  EXPECT_EQ(heading_reach(4.0), std::numbers::pi);
}

TEST(Outage, ATurnTakesTheVelocityAlong) {
  NominalState state = walking().state;
  state.position = {3.0, 4.0, 0.0};
  const NominalState after = turned(state, 0.5 * std::numbers::pi);
  EXPECT_NEAR(yaw_of(after.rotation), 0.5 * std::numbers::pi, 1e-12);
  EXPECT_LT((after.velocity - Eigen::Vector3d(0.0, 0.7, 0.0)).norm(), 1e-12);
  EXPECT_EQ(after.position, state.position);
}

}  // namespace
}  // namespace aims
