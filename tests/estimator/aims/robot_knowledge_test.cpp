// SPDX-License-Identifier: BSD-3-Clause
#include "estimator/aims/robot_knowledge.hpp"

#include <gtest/gtest.h>

#include "estimator/aims/presets.hpp"

namespace aims {
namespace {

using E = ErrorState;

/// Legs of a file: 10 % of scale ahead, known to 0.2 %.
EskfConfig calibrated_config() {
  EskfConfig config = eskf_preset("aims_d");
  Gaussian legs{Eigen::VectorXd::Zero(6), 4e-6 * Eigen::MatrixXd::Identity(6, 6)};
  legs.mean(0) = 0.1;
  config.prior.enabled = true;
  config.prior.legs_by_feet = numbers_of(legs);
  return config;
}

/// The belief after scans have shown the scale `truth` with the deviation `sigma`.
Belief after_scans(const Belief& belief, double truth, double sigma) {
  LinearMeasurement m;
  columns(m.jacobian, E::kLegScale).setIdentity();
  m.residual = belief.state.leg_scale - Eigen::Vector3d(truth, 0.0, 0.0);
  m.noise = sigma * sigma * Eigen::Matrix3d::Identity();
  return fuse(belief, m);
}

TEST(RobotKnowledge, LegsStartAsTheyAreCalibrated) {
  RobotKnowledge robot(calibrated_config(), 50.0);
  const Belief belief = robot.at_first_legs(robot.at_start(Belief()), true);
  EXPECT_NEAR(belief.state.leg_scale.x(), 0.1, 1e-12);
  EXPECT_NEAR(belief.covariance(E::kLegScale.offset, E::kLegScale.offset), 4e-6, 1e-12);
  EXPECT_TRUE(robot.legs_are_known());
}

TEST(RobotKnowledge, LegsMeasuredAnotherWayAreNotKnown) {
  RobotKnowledge robot(calibrated_config(), 50.0);
  const Belief belief = robot.at_first_legs(robot.at_start(Belief()), false);
  EXPECT_EQ(belief.state.leg_scale.x(), 0.0);
  EXPECT_FALSE(robot.legs_are_known());
}

TEST(RobotKnowledge, ScansThatContradictTheCalibrationOverruleIt) {
  for (const double truth : {0.1, 0.0}) {
    RobotKnowledge robot(calibrated_config(), 50.0);
    Belief belief = robot.at_first_legs(robot.at_start(Belief()), true);
    std::vector<std::string> contradicted;
    for (int i = 0; i < 50; ++i) {
      belief = robot.after_scan(belief, after_scans(belief, truth, 0.02), 0.1);
      for (const std::string& each : robot.take_contradictions()) contradicted.push_back(each);
    }
    if (truth == 0.1) {
      EXPECT_TRUE(contradicted.empty());
    } else {
      ASSERT_EQ(contradicted, std::vector<std::string>{"legs_by_feet"});
      EXPECT_NEAR(belief.state.leg_scale.x(), 0.0, 0.015) << "the data decide";
    }
  }
}

/// A straight walk of 40 m at 0.5 m/s by scans, which legs make 2 % longer, and a turn in which
/// they go astray.
TEST(LegComparison, ShowsTheScaleOfStraightWays) {
  LegComparison comparison;
  NominalState scans;
  NominalState legs;
  for (int i = 0; i < 800; ++i) {
    scans.position.x() += 0.05;
    legs.position.x() += 0.05 * 1.02;
    comparison.add(legs, scans, 0.1, true);
  }
  for (int i = 0; i < 30; ++i) {
    scans.rotation = scans.rotation * so3_exp(Eigen::Vector3d(0.0, 0.0, 0.1));
    scans.position.x() += 0.05;
    legs.position.x() += 1.0;
    comparison.add(legs, scans, 0.1, true);
  }
  legs.leg_scale.x() = 0.01;
  const Eigen::MatrixXd information = comparison.information();
  const Eigen::VectorXd vector = comparison.vector(legs);
  // The row 0.5 s + b = z, with z = 0.5 * 1.02 * 1.01 - 0.5.
  EXPECT_NEAR(vector(3) / information(3, 3), 0.5 * (1.02 * 1.01 - 1.0), 1e-3);
  EXPECT_NEAR(information(0, 3) / information(3, 3), 0.5, 1e-3);
  EXPECT_EQ(information(1, 1), 0.0) << "no way was walked sideways";
}

/// Scans that leave the way free follow the noise of their map, here 10 % short, and a step where
/// they find the way again is no walk.
TEST(LegComparison, CountsOnlyWhereScansConstrainTheWay) {
  for (const bool any : {true, false}) {
    LegComparison comparison;
    NominalState scans;
    NominalState legs;
    for (int i = 0; i < 1600; ++i) {
      const bool constrained = any && i / 200 % 2 == 0;
      const bool found_again = constrained && i > 0 && i % 400 == 0;
      scans.position.x() += (constrained ? 0.05 : 0.045) + (found_again ? 1.0 : 0.0);
      legs.position.x() += 0.05;
      comparison.add(legs, scans, 0.1, constrained);
    }
    const Eigen::MatrixXd information = comparison.information();
    EXPECT_EQ(information.isZero(0.0), !any);
    if (any) EXPECT_NEAR(comparison.vector(legs)(3) / information(3, 3), 0.0, 1e-9);
  }
}

TEST(LegComparison, SaysNothingAfterAShortWay) {
  LegComparison comparison;
  NominalState state;
  for (int i = 0; i < 100; ++i) {
    state.position.x() += 0.05;
    comparison.add(state, state, 0.1, true);
  }
  EXPECT_TRUE(comparison.information().isZero(0.0));
}

}  // namespace
}  // namespace aims
