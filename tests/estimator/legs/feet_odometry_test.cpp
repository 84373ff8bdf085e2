// SPDX-License-Identifier: BSD-3-Clause
#include "estimator/legs/feet_odometry.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace aims {
namespace {

constexpr LegGeometry kLegs{0.188, 0.047, 0.08, 0.213, 0.213, 0.022};
constexpr Duration kPacket = 5 * kMillisecond;
constexpr double kGravity = 9.81;
constexpr double kSoft = 1.0;      // W / K [rad/m]
constexpr double kRubber = 0.005;  // W / k [m]

/// Load on `leg` at `time` [s] as a part of a quarter of the weight: it rises over each stance of
/// 0.2 s, and the diagonal pairs alternate.
double load_of(int leg, double time) {
  const double late = leg == 0 || leg == 3 ? 0.0 : 0.1;
  return 0.5 + std::fmod(time + late, 0.2) / 0.2;
}

/// A robot on rubber feet with joints of that compliance that treads on the spot at a constant
/// height: by its encoders it sinks.
LegOdometrySample packet(Time stamp, double compliance) {
  LegOdometrySample sample;
  sample.stamp = stamp;
  sample.contact.fill(true);
  sample.contact_force.emplace();
  for (int leg = 0; leg < kLegCount; ++leg) {
    const double load = load_of(leg, to_seconds(stamp));
    const Eigen::Vector3d foot =
        hip_in_base(leg, kLegs) +
        Eigen::Vector3d(0.03, side_of(leg) * 0.08, -0.29 - kRubber * 0.25 * load);
    const Eigen::Vector3d angle = leg_angles(leg, foot, kLegs);
    const Eigen::Vector3d yields = compliance * 0.25 * load *
                                   foot_jacobian(leg, angle, kLegs).transpose() *
                                   Eigen::Vector3d::UnitZ();
    Eigen::Map<Eigen::Vector3d>(sample.joint_position.data() + 3 * leg) = angle - yields;
    (*sample.contact_force)[static_cast<std::size_t>(leg)] = 30.0 * load;
  }
  return sample;
}

/// The compliance after 25 s at a constant height, for a belief whose feet pull its vertical
/// velocity to `pull` and pass for its bias `bias` [m/s].
double compliance_learned(double compliance, double pull = 0.0, double bias = 0.0) {
  SensorRig rig;
  rig.leg_geometry = kLegs;
  FeetOdometry feet(FeetConfig{.enabled = true}, rig, kGravity, VerticalReference::kHeight);
  ImuHistory imu({}, 50.0);
  Belief belief;
  belief.covariance = 1e-3 * ErrorMatrix::Identity();
  belief.state.velocity.z() = pull;
  belief.state.leg_bias.z() = bias;
  Time sampled = 0;
  for (Time stamp = kSecond; stamp < 26 * kSecond; stamp += kPacket) {
    for (; sampled <= stamp + kSecond / 10; sampled += kSecond / 50) {
      imu.insert({sampled, Eigen::Vector3d::Zero(), kGravity * Eigen::Vector3d::UnitZ()});
    }
    (void)feet.measure(packet(stamp, compliance), belief, imu);
    imu.forget_before(stamp - kSecond);
  }
  return feet.compliance().value();
}

TEST(FeetOdometry, SoftJointsShowAgainstTheHeightThatScansHold) {
  EXPECT_NEAR(compliance_learned(kSoft), kSoft, 0.3 * kSoft);  // drawn to the prior
}

TEST(FeetOdometry, RubberFeetDoNotPassForSoftJoints) {
  EXPECT_LT(compliance_learned(0.0), 0.06);
}

// Feet that sink pull the velocity of the belief between two scans, and scans explain the rest by a
// bias of the legs: against that velocity the joints would pass for stiff, and strides for short.
TEST(FeetOdometry, AVelocityThatFeetPullHidesNoCompliance) {
  const double learned = compliance_learned(kSoft);
  EXPECT_NEAR(compliance_learned(kSoft, -0.02, 0.0), learned, 0.05 * learned);
  EXPECT_NEAR(compliance_learned(kSoft, 0.0, -0.02), learned, 0.05 * learned);
}

}  // namespace
}  // namespace aims
