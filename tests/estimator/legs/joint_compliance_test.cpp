// SPDX-License-Identifier: BSD-3-Clause
#include "estimator/legs/joint_compliance.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace aims {
namespace {

constexpr LegGeometry kLegs{0.188, 0.047, 0.08, 0.213, 0.213, 0.022};
constexpr double kRate = 200.0;

LegOdometrySample standing(double load) {
  LegOdometrySample sample;
  for (int leg = 0; leg < kLegCount; ++leg) {
    const Eigen::Vector3d q = leg_angles(
        leg, hip_in_base(leg, kLegs) + Eigen::Vector3d(0.03, side_of(leg) * 0.08, -0.29), kLegs);
    for (int i = 0; i < 3; ++i) sample.joint_position[static_cast<std::size_t>(3 * leg + i)] = q[i];
  }
  sample.contact_force = FootLoads{load, load, load, load};
  return sample;
}

// tau = J^T f, and each foot carries a quarter: K dq = J^T u W / 4.
TEST(JointCompliance, YieldsByTheTorqueOfItsShareOfTheLoad) {
  JointCompliance compliance;
  const LegOdometrySample sample = standing(31.0);
  const JointVector yield =
      yield_of_joints(Eigen::Map<const JointVector>(sample.joint_position.data()),
                      compliance.shares(sample, kRate), Eigen::Vector3d::UnitZ(), kLegs);
  const double stiffness = 200.0;
  const double weight = 4.0 * 31.0;
  for (int leg = 0; leg < kLegCount; ++leg) {
    const Eigen::Vector3d q(standing(31.0).joint_position.data() + 3 * leg);
    const Eigen::Vector3d torque =
        foot_jacobian(leg, q, kLegs).transpose() * Eigen::Vector3d(0.0, 0.0, 31.0);
    EXPECT_LT((weight / stiffness * joints_of(yield, leg) - torque / stiffness).norm(), 1e-12);
  }
}

TEST(JointCompliance, StaysAtItsPriorWithoutLoads) {
  JointCompliance compliance;
  LegOdometrySample sample = standing(0.0);
  sample.contact_force.reset();
  EXPECT_TRUE(compliance.shares(sample, kRate).isZero(0.0));
  const double before = compliance.value();
  for (int i = 0; i < 1000; ++i) compliance.update({-0.1, 0.0}, kRate);
  EXPECT_EQ(compliance.value(), before);
}

// Rigid legs of a robot with the compliance `truth` sink by 0.1 m/s per unit of it.
TEST(JointCompliance, IsLearnedFromTheVerticalDrift) {
  for (double truth : {0.0, 0.3, 1.5}) {
    JointCompliance compliance;
    for (int i = 0; i < 60 * 200; ++i) {
      const double ripple = 0.2 * std::sin(2.0 * M_PI * 4.0 * i / kRate);
      compliance.update({-0.1 * truth + ripple, 0.1}, kRate);
    }
    EXPECT_NEAR(compliance.value(), truth, 0.1 * truth + 0.02);
  }
}

TEST(JointCompliance, StaysAfterTwentySecondsOfWalking) {
  JointCompliance compliance;
  for (int i = 0; i < 19 * 200; ++i) compliance.update({-0.03, 0.1}, kRate);
  EXPECT_FALSE(compliance.is_learned());
  for (int i = 0; i < 2 * 200; ++i) compliance.update({-0.03, 0.1}, kRate);
  EXPECT_TRUE(compliance.is_learned());
  const double learned = compliance.value();
  for (int i = 0; i < 60 * 200; ++i) compliance.update({0.1, 0.1}, kRate);
  EXPECT_EQ(compliance.value(), learned);
}

// A drift within that of rigid legs says little, however long the robot walks.
TEST(JointCompliance, ADriftThatRigidLegsHaveIsNotCompliance) {
  JointCompliance compliance;
  for (int i = 0; i < 600 * 200; ++i) compliance.update({-0.005, 0.02}, kRate);
  EXPECT_GT(compliance.value(), 0.05);
  EXPECT_LT(compliance.value(), 0.15);  // 0.25 by that drift alone
}

// At 0.5 m/s with 0.06 m/s per unit of compliance.
TEST(JointCompliance, KnowsWhichPartOfTheWayJointsTake) {
  JointCompliance compliance;
  const JointCompliance::Drift soft{
      .climb = -0.1, .joints = 0.1, .rubber = 0.0, .along = 0.06, .speed = 0.5};
  for (int i = 0; i < 300; ++i) compliance.update(soft, kRate);
  EXPECT_EQ(compliance.part_of_way(), 0.0) << "after less than a metre";
  for (int i = 0; i < 5000; ++i) compliance.update(soft, kRate);
  EXPECT_NEAR(compliance.part_of_way(), 0.12 * compliance.value(), 1e-12);
  EXPECT_GT(compliance.part_of_way(), 0.1);
}

TEST(JointCompliance, IsNeverNegative) {
  JointCompliance compliance;
  for (int i = 0; i < 4000; ++i) compliance.update({0.1, 0.1}, kRate);
  EXPECT_EQ(compliance.value(), 0.0);
}

}  // namespace
}  // namespace aims
