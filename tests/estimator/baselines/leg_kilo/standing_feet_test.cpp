// SPDX-License-Identifier: BSD-3-Clause
#include "estimator/baselines/leg_kilo/observations.hpp"

#include <gtest/gtest.h>

#include <Eigen/LU>

#include "core/leg_kinematics.hpp"

namespace aims::leg_kilo {
namespace {

/// A robot whose base turns and moves while its feet stand on the ground.
class WalkingRobot : public ::testing::Test {
 protected:
  WalkingRobot() {
    rig_.leg_geometry = {.hip_x = 0.19,
                         .hip_y = 0.05,
                         .abduction = 0.08,
                         .thigh = 0.21,
                         .calf = 0.22,
                         .foot_radius = 0.02};
    rig_.T_body_base = {so3_exp({0.05, -0.1, 0.3}), {0.1, -0.02, -0.06}};
    sample_.linear_velocity = {0.7, -0.1, 0.05};
    sample_.angular_velocity = {0.2, -0.3, 0.5};
    for (int leg = 0; leg < kLegCount; ++leg) {
      const Eigen::Vector3d q(0.1 - 0.05 * leg, 0.8 + 0.1 * leg, -1.6 + 0.1 * leg);
      const Eigen::Vector3d rate =
          foot_jacobian(leg, q, rig_.leg_geometry).inverse() *
          -(sample_.linear_velocity +
            sample_.angular_velocity.cross(foot_in_base(leg, q, rig_.leg_geometry)));
      for (int k = 0; k < 3; ++k) {
        sample_.joint_position[static_cast<std::size_t>(3 * leg + k)] = q(k);
        sample_.joint_velocity[static_cast<std::size_t>(3 * leg + k)] = rate(k);
      }
    }
  }

  /// The true state with the IMU at the base: attitude arbitrary.
  State truth() const {
    State x;
    x.T_world_body = {so3_exp({0.2, 0.1, -1.3}), {5.0, 1.0, 0.3}};
    const Eigen::Quaterniond R_world_base = x.T_world_body.rotation * rig_.T_body_base.rotation;
    x.velocity = R_world_base * sample_.linear_velocity;
    x.rate = rig_.T_body_base.rotation * sample_.angular_velocity;
    return x;
  }

  /// Largest innovation of the feet at the true state [m/s].
  double largest_innovation(const std::vector<StandingFoot>& feet) const {
    const Observation rows = inertial_observation(truth(), Inertial(), feet, ImuVariances(), 0.1);
    return rows.innovation.tail(3 * static_cast<Eigen::Index>(feet.size())).cwiseAbs().maxCoeff();
  }

  SensorRig rig_;
  LegOdometrySample sample_;
};

TEST_F(WalkingRobot, FeetInContactStandAtTheTrueState) {
  sample_.contact = {true, false, true, true};
  const std::vector<StandingFoot> feet = feet_in_contact(sample_, rig_);
  ASSERT_EQ(feet.size(), 3U);
  EXPECT_LT(largest_innovation(feet), 1e-12);
  const Eigen::Vector3d rear_left = {sample_.joint_position[6], sample_.joint_position[7],
                                     sample_.joint_position[8]};
  EXPECT_LT(
      (feet[1].position - rig_.T_body_base.rotation * foot_in_base(2, rear_left, rig_.leg_geometry))
          .norm(),
      1e-12);
}

TEST_F(WalkingRobot, FeetOfTheTwistStandAtTheTrueState) {
  const std::vector<StandingFoot> feet = feet_of_twist(sample_, rig_);
  ASSERT_EQ(feet.size(), 4U);
  EXPECT_LT(largest_innovation(feet), 1e-12);
  for (const StandingFoot& foot : feet) {
    const Eigen::Vector3d in_base = rig_.T_body_base.rotation.conjugate() * foot.position;
    EXPECT_NEAR(std::abs(in_base.x()), 0.19, 1e-12);
    EXPECT_NEAR(std::abs(in_base.y()), 0.13, 1e-12);
    EXPECT_NEAR(in_base.z(), -0.301, 1e-12);
  }
}

TEST_F(WalkingRobot, JointsNeedAnglesAndTheLengthsOfTheLegs) {
  EXPECT_TRUE(has_joints(sample_, rig_));
  EXPECT_FALSE(has_joints(sample_, SensorRig()));
  sample_.joint_position.fill(0.0);
  EXPECT_FALSE(has_joints(sample_, rig_));
}

TEST(ContactHysteresis, BeginsAboveOneForceAndEndsBelowALowerOne) {
  ContactHysteresis contacts(20.0, 10.0);
  const auto contact_at = [&](double force) {
    LegOdometrySample sample;
    sample.contact_force = FootLoads{force, 100.0, force, 0.0};
    return contacts.update(sample)[0];
  };
  EXPECT_TRUE(contact_at(10.0)) << "in contact at first";
  EXPECT_FALSE(contact_at(9.9));
  EXPECT_FALSE(contact_at(20.0));
  EXPECT_TRUE(contact_at(20.1));
  EXPECT_TRUE(contact_at(15.0));
  EXPECT_FALSE(contact_at(-5.0));
  LegOdometrySample reported;
  reported.contact = {true, false, true, false};
  EXPECT_EQ(contacts.update(reported), reported.contact) << "without forces";
}

}  // namespace
}  // namespace aims::leg_kilo
