// SPDX-License-Identifier: BSD-3-Clause
#include "estimator/legs/feet.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace aims {
namespace {

constexpr LegGeometry kLegs{0.188, 0.047, 0.08, 0.213, 0.213, 0.022};
const Eigen::Vector3d kUp = Eigen::Vector3d::UnitZ();
const std::array<bool, kLegCount> kAllStand{true, true, true, true};

/// Angles of all joints whose feet stand at those places in the base.
JointVector angles_of(const FootVelocities& feet) {
  JointVector angles;
  for (int leg = 0; leg < kLegCount; ++leg) {
    angles.segment<3>(3 * leg) = leg_angles(leg, feet[static_cast<std::size_t>(leg)], kLegs);
  }
  return angles;
}

/// Feet below the hips, moved by `offset` in the base [m].
FootVelocities feet_below_hips(const Eigen::Vector3d& offset) {
  FootVelocities feet;
  for (int leg = 0; leg < kLegCount; ++leg) {
    feet[static_cast<std::size_t>(leg)] =
        hip_in_base(leg, kLegs) + Eigen::Vector3d(0.0, side_of(leg) * kLegs.abduction, -0.29) +
        offset;
  }
  return feet;
}

TEST(JointDifference, IsTheMeanRateAtTheMiddleOfTheInterval) {
  JointDifference difference;
  const auto angle = [](double t) { return JointVector(JointVector::Constant(0.5 * t * t)); };
  EXPECT_FALSE(difference.update({0, angle(0.0), JointVector::Zero()}));
  const auto state = difference.update({10 * kMillisecond, angle(0.01), JointVector::Zero()});
  ASSERT_TRUE(state);
  EXPECT_NEAR(state->rate[0], 0.005, 1e-12);  // the rate of the parabola at 5 ms
  EXPECT_NEAR(state->age, 0.005, 1e-12);
}

TEST(JointDifference, SpansSeveralPacketsOfAFastStreamAndNoGap) {
  JointDifference difference;
  for (int i = 0; i < 10; ++i) {
    const auto state =
        difference.update({i * kMillisecond, JointVector::Constant(i), JointVector::Zero()});
    EXPECT_EQ(state.has_value(), i >= 4) << i;
    if (state) {
      EXPECT_NEAR(state->age, 0.002, 1e-12);
    }
  }
  EXPECT_FALSE(difference.update({kSecond, JointVector::Zero(), JointVector::Zero()}));
}

// A driver that reads its encoders at 50 Hz and sends at 200.
TEST(JointDifference, AnglesThatAreSentAgainAreNoReading) {
  JointDifference difference;
  for (int i = 0; i < 20; ++i) {
    const JointVector angle = JointVector::Constant(0.1 * (1 + i / 4));
    const auto state = difference.update({i * 5 * kMillisecond, angle, JointVector::Zero()});
    EXPECT_EQ(state.has_value(), i >= 4 && i % 4 == 0) << i;
    if (state) {
      EXPECT_NEAR(state->rate[0], 5.0, 1e-9);
      EXPECT_NEAR(state->age, 0.01, 1e-12);
      EXPECT_EQ(state->repeats, 3);
    }
  }
}

TEST(JointDifference, ARepeatBeforeAGapBridgesItNot) {
  JointDifference difference;
  const auto at = [&](int ms, double angle) {
    return difference.update({ms * kMillisecond, JointVector::Constant(angle), JointVector::Zero()})
        .has_value();
  };
  EXPECT_FALSE(at(200, 1.0));
  EXPECT_FALSE(at(202, 1.0));
  EXPECT_TRUE(at(204, 1.1));
  EXPECT_FALSE(at(206, 1.1));
  EXPECT_FALSE(at(290, 1.5));
  EXPECT_FALSE(at(292, 1.5));
  EXPECT_TRUE(at(294, 1.6));
}

TEST(JointDifference, AnglesThatStayAreThoseOfARobotThatStands) {
  JointDifference difference;
  const JointVector angle = JointVector::Ones();
  std::optional<JointState> state;
  for (int i = 0; i < 30; ++i) {
    state = difference.update({i * 5 * kMillisecond, angle, JointVector::Zero()});
  }
  ASSERT_TRUE(state);
  EXPECT_EQ(state->rate, JointVector::Zero());
}

// The centre of a rolling foot moves against the ground by r times the turn of the calf.
TEST(FeetVelocities, AreTheVelocityOfABaseWhoseFeetRoll) {
  const Eigen::Vector3d velocity(0.6, -0.1, 0.05);
  constexpr double kStep = 1e-5;
  // Places of the feet in the base, half a step before and after: the contact points rest, and the
  // centre of each foot lies r above where the ground is touched.
  JointState joints;
  joints.angle = angles_of(feet_below_hips(Eigen::Vector3d::Zero()));
  JointVector rate = JointVector::Zero();
  for (int pass = 0; pass < 50; ++pass) {  // the rolling depends on the rates
    for (int leg = 0; leg < kLegCount; ++leg) {
      const Eigen::Vector3d q = joints_of(joints.angle, leg);
      const Eigen::Vector3d calf = calf_rate_in_base(q, joints_of(rate, leg));
      const Eigen::Vector3d centre = -velocity + calf.cross(kLegs.foot_radius * kUp);
      const Eigen::Vector3d after =
          leg_angles(leg, foot_in_base(leg, q, kLegs) + kStep * centre, kLegs);
      const Eigen::Vector3d before =
          leg_angles(leg, foot_in_base(leg, q, kLegs) - kStep * centre, kLegs);
      rate.segment<3>(3 * leg) = (after - before) / (2.0 * kStep);
    }
  }
  joints.rate = rate;
  for (const Eigen::Vector3d& each :
       velocities_from_feet(joints, 0.0, Eigen::Vector3d::Zero(), kUp, kLegs)) {
    EXPECT_LT((each - velocity).norm(), 1e-6);
  }
}

TEST(FeetWeights, ASwingingFootCountsNothingWithContactToo) {
  const Eigen::Vector3d walking(0.9, 0.0, 0.0);
  FootVelocities feet{walking, -1.4 * walking, -1.4 * walking, walking};
  const FootWeights weights = weights_of_feet(feet, kAllStand, walking, 1e-3);
  EXPECT_NEAR(weights[0], 1.0, 1e-9);
  EXPECT_LT(weights[1], 1e-3);
  EXPECT_LT((mean_of_feet(feet, weights) - walking).norm(), 5e-3);
}

TEST(FeetWeights, APredictionThatKnowsNothingTakesEveryFoot) {
  const FootVelocities feet{Eigen::Vector3d(0.9, 0.0, 0.0), Eigen::Vector3d(0.8, 0.0, 0.0),
                            Eigen::Vector3d(1.0, 0.0, 0.0), Eigen::Vector3d(0.9, 0.0, 0.0)};
  const FootWeights weights = weights_of_feet(feet, kAllStand, Eigen::Vector3d::Zero(), 100.0);
  EXPECT_GT(total_weight(weights), 3.9);
  EXPECT_NEAR(mean_of_feet(feet, weights).x(), 0.9, 1e-3);
}

TEST(FeetWeights, WithoutAnyContactTheFeetThatFitStillCount) {
  const Eigen::Vector3d walking(0.9, 0.0, 0.0);
  const FootVelocities feet{walking, -walking, -walking, walking};
  const FootWeights weights = weights_of_feet(feet, {}, walking, 1e-3);
  EXPECT_GT(total_weight(weights), 0.1);
  EXPECT_NEAR(mean_of_feet(feet, weights).x(), 0.9, 0.01);
}

TEST(FeetWeights, BackwardMotionOfAFootCountsLess) {
  const Eigen::Vector3d walking(0.9, 0.0, 0.0);
  const Eigen::Vector3d apart(0.4, 0.0, 0.0);
  const FootVelocities feet{walking + apart, walking - apart, walking, walking};
  const FootWeights weights = weights_of_feet(feet, kAllStand, walking, 0.0);
  EXPECT_GT(weights[0], 1.5 * weights[1]);
}

TEST(FeetWeights, ANonFiniteFootGivesNoMeasurement) {
  const FootVelocities feet{Eigen::Vector3d::Constant(NAN), Eigen::Vector3d::Zero(),
                            Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero()};
  EXPECT_EQ(total_weight(weights_of_feet(feet, kAllStand, Eigen::Vector3d::Zero(), 0.0)), 0.0);
}

}  // namespace
}  // namespace aims
