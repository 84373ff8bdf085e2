// SPDX-License-Identifier: BSD-3-Clause
#include "sim/leg_kinematics.hpp"

#include <gtest/gtest.h>

#include "core/lie.hpp"
#include "core/random.hpp"

namespace aims {
namespace {

Eigen::Vector3d random_angles(RandomStream& random) {
  return {random.uniform(-0.6, 0.6), random.uniform(0.0, 1.5), random.uniform(-2.4, -0.8)};
}

TEST(LegKinematics, JacobianMatchesFiniteDifferences) {
  RandomStream random(1, "test");
  const double h = 1e-6;
  for (int trial = 0; trial < 40; ++trial) {
    const int leg = trial % kLegCount;
    const Eigen::Vector3d q = random_angles(random);
    const Eigen::Matrix3d J = foot_jacobian(leg, q);
    for (int i = 0; i < 3; ++i) {
      const Eigen::Vector3d step = h * Eigen::Vector3d::Unit(i);
      const Eigen::Vector3d numeric =
          (foot_in_base(leg, q + step) - foot_in_base(leg, q - step)) / (2.0 * h);
      EXPECT_LT((J.col(i) - numeric).norm(), 1e-8) << "trial " << trial << " joint " << i;
    }
  }
}

TEST(LegKinematics, AnglesBringTheFootBackToWhereItWas) {
  RandomStream random(2, "test");
  for (int trial = 0; trial < 40; ++trial) {
    const int leg = trial % kLegCount;
    const Eigen::Vector3d q = random_angles(random);
    EXPECT_LT((leg_angles(leg, foot_in_base(leg, q)) - q).norm(), 1e-9) << "trial " << trial;
  }
}

TEST(LegKinematics, LeftAndRightAreMirrored) {
  const Eigen::Vector3d left = foot_in_base(0, {0.2, 0.8, -1.5});
  const Eigen::Vector3d right = foot_in_base(1, {-0.2, 0.8, -1.5});
  EXPECT_LT((left - right.cwiseProduct(Eigen::Vector3d(1.0, -1.0, 1.0))).norm(), 1e-12);
}

TEST(LegKinematics, AnglesForAPointOutOfReachAreFinite) {
  EXPECT_TRUE(leg_angles(0, {0.0, 0.0, -3.0}).allFinite());
  EXPECT_TRUE(leg_angles(0, hip_in_base(0)).allFinite());
}

}  // namespace
}  // namespace aims
