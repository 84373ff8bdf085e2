// SPDX-License-Identifier: BSD-3-Clause
#include "core/leg_kinematics.hpp"

#include <gtest/gtest.h>

#include "core/lie.hpp"
#include "core/random.hpp"

namespace aims {
namespace {

/// Of a quadruped [m].
constexpr LegGeometry kGeometry{.hip_x = 0.188,
                                .hip_y = 0.047,
                                .abduction = 0.08,
                                .thigh = 0.213,
                                .calf = 0.213,
                                .foot_radius = 0.022};

Eigen::Vector3d random_angles(RandomStream& random) {
  return {random.uniform(-0.6, 0.6), random.uniform(0.0, 1.5), random.uniform(-2.4, -0.8)};
}

TEST(LegKinematics, JacobianMatchesFiniteDifferences) {
  RandomStream random(1, "test");
  const double h = 1e-6;
  for (int trial = 0; trial < 40; ++trial) {
    const int leg = trial % kLegCount;
    const Eigen::Vector3d q = random_angles(random);
    const Eigen::Matrix3d J = foot_jacobian(leg, q, kGeometry);
    for (int i = 0; i < 3; ++i) {
      const Eigen::Vector3d step = h * Eigen::Vector3d::Unit(i);
      const Eigen::Vector3d numeric =
          (foot_in_base(leg, q + step, kGeometry) - foot_in_base(leg, q - step, kGeometry)) /
          (2.0 * h);
      EXPECT_LT((J.col(i) - numeric).norm(), 1e-8) << "trial " << trial << " joint " << i;
    }
  }
}

TEST(LegKinematics, InverseKinematicsInvertsForwardKinematics) {
  RandomStream random(2, "test");
  for (int trial = 0; trial < 40; ++trial) {
    const int leg = trial % kLegCount;
    const Eigen::Vector3d q = random_angles(random);
    const Eigen::Vector3d back = leg_angles(leg, foot_in_base(leg, q, kGeometry), kGeometry);
    EXPECT_LT((back - q).norm(), 1e-9) << "trial " << trial;
  }
}

TEST(LegKinematics, LeftAndRightAreMirrored) {
  const Eigen::Vector3d left = foot_in_base(0, {0.2, 0.8, -1.5}, kGeometry);
  const Eigen::Vector3d right = foot_in_base(1, {-0.2, 0.8, -1.5}, kGeometry);
  EXPECT_LT((left - right.cwiseProduct(Eigen::Vector3d(1.0, -1.0, 1.0))).norm(), 1e-12);
}

TEST(LegKinematics, AnglesForAPointOutOfReachAreFinite) {
  EXPECT_TRUE(leg_angles(0, {0.0, 0.0, -3.0}, kGeometry).allFinite());
  EXPECT_TRUE(leg_angles(0, hip_in_base(0, kGeometry), kGeometry).allFinite());
}

/// A base that moves rigidly over a foot that stays: the pose after `dt` keeps the foot in place.
TEST(LegKinematics, VelocityFromAStaticFootKeepsTheFootInPlace) {
  RandomStream random(3, "test");
  const double dt = 1e-6;
  LegGeometry long_legs = kGeometry;
  long_legs.thigh = 0.3;
  long_legs.hip_y = 0.1;
  for (int trial = 0; trial < 40; ++trial) {
    const int leg = trial % kLegCount;
    const LegMotion motion{random_angles(random), random.normal3(), 0.5 * random.normal3()};
    const Eigen::Vector3d velocity = velocity_from_foot(leg, motion, long_legs);
    const auto foot_after = [&](double t) -> Eigen::Vector3d {
      return velocity * t +
             so3_exp(motion.turning * t) * foot_in_base(leg, motion.q + motion.rate * t, long_legs);
    };
    EXPECT_LT((foot_after(dt) - foot_after(-dt)).norm() / (2.0 * dt), 1e-8) << "trial " << trial;
  }
}

TEST(LegKinematics, ARollingFootAddsTheSpeedOfItsCentreOverTheFloor) {
  // The calf pitches forward at 2 rad/s over a foot of 22 mm: its centre runs at 44 mm/s.
  const LegMotion motion{{0.0, 0.8, -1.6}, {0.0, 2.0, 0.0}, Eigen::Vector3d::Zero()};
  const Eigen::Vector3d rolling =
      velocity_from_rolling_foot(0, motion, Eigen::Vector3d::UnitZ(), kGeometry);
  const Eigen::Vector3d difference = rolling - velocity_from_foot(0, motion, kGeometry);
  EXPECT_LT((difference - Eigen::Vector3d(0.044, 0.0, 0.0)).norm(), 1e-12);
}

}  // namespace
}  // namespace aims
