// SPDX-License-Identifier: BSD-3-Clause
#include "sim/sensors/leg_compliance.hpp"

#include <gtest/gtest.h>

#include "sim/robot/robot_geometry.hpp"

namespace aims {
namespace {

constexpr Duration kStep = 2'500'000;

/// Standing on four legs, the base rolled and pitched, with a force on the rear left foot.
RobotState loaded_state(const Eigen::Vector3d& force) {
  RobotState state;
  state.T_world_base.rotation = so3_exp(Eigen::Vector3d(0.1, -0.2, 0.7));
  state.q = standing_joints(kRobotGeometry, 0.27, 0.09);
  state.foot_force[2] = force;
  state.foot_load[2] = force.z();
  return state;
}

Eigen::Vector3d foot(const JointVector& q) {
  return foot_in_base(2, joints_of(q, 2), kRobotGeometry);
}

TEST(LegCompliance, ARigidLegChangesNothing) {
  const RobotState state = loaded_state({5.0, 2.0, 60.0});
  LegCompliance legs({}, kRobotGeometry, kStep);
  EXPECT_EQ(legs.update(state).angle, state.q);
  EXPECT_EQ(legs.update(state).rate, state.qd);
}

/// Hooke: the encoders place the foot f / k beyond where it is, against the force.
TEST(LegCompliance, TheRubberFootYieldsByForceOverStiffness) {
  LegOdometryConfig config;
  config.foot_stiffness = 2e4;
  const RobotState state = loaded_state({8.0, -6.0, 60.0});
  const JointMotion measured = LegCompliance(config, kRobotGeometry, kStep).update(state);
  const Eigen::Vector3d shift =
      state.T_world_base.rotation * (foot(measured.angle) - foot(state.q));
  EXPECT_LT((shift + state.foot_force[2] / 2e4).norm(), 1e-4);
  EXPECT_EQ(joints_of(measured.angle, 0), joints_of(state.q, 0)) << "an unloaded leg";
}

/// Virtual work: the torque of a joint is the force times the motion of the foot per radian.
TEST(LegCompliance, AJointYieldsByTorqueOverStiffness) {
  LegOdometryConfig config;
  config.joint_stiffness = 250.0;
  const RobotState state = loaded_state({8.0, -6.0, 60.0});
  const JointMotion measured = LegCompliance(config, kRobotGeometry, kStep).update(state);
  for (int joint = 0; joint < 3; ++joint) {
    JointVector moved = state.q;
    moved[6 + joint] += 1e-6;
    const double work =
        state.foot_force[2].dot(state.T_world_base.rotation * (foot(moved) - foot(state.q)));
    EXPECT_NEAR(measured.angle[6 + joint], state.q[6 + joint] - work / 1e-6 / 250.0, 1e-6);
  }
}

/// A load that comes at once: the deflection follows exponentially, its rate is its derivative.
TEST(LegCompliance, TheRateIsTheDerivativeOfTheAngle) {
  LegOdometryConfig config;
  config.joint_stiffness = 250.0;
  config.compliance_time = 0.01;
  LegCompliance legs(config, kRobotGeometry, kStep);
  JointVector before = legs.update(loaded_state(Eigen::Vector3d::Zero())).angle;
  JointMotion now;
  for (int i = 0; i < 40; ++i) {
    now = legs.update(loaded_state({0.0, 0.0, 60.0}));
    EXPECT_LT((now.rate - (now.angle - before) / to_seconds(kStep)).norm(), 1e-9);
    before = now.angle;
  }
  const JointVector settled =
      LegCompliance(config, kRobotGeometry, kStep).update(loaded_state({0, 0, 60})).angle;
  EXPECT_LT((now.angle - settled).norm(), 1e-4);
}

}  // namespace
}  // namespace aims
