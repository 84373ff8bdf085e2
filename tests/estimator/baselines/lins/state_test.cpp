// SPDX-License-Identifier: BSD-3-Clause
#include "estimator/baselines/lins/filter.hpp"

#include <gtest/gtest.h>

#include "tests/estimator/baselines/lins/random_states.hpp"

namespace aims::lins {
namespace {

constexpr unsigned kSeed = 3;

TEST(LinsState, PlusAndMinusAreInverse) {
  std::mt19937 random(kSeed);
  for (int i = 0; i < 10; ++i) {
    const State x = test::random_state(random);
    const ErrorVector error = test::random_error(random, 0.4);
    EXPECT_LT((minus(plus(x, error), x) - error).norm(), 1e-12) << "seed " << kSeed;
  }
}

TEST(LinsState, ARebasedBeliefHasNoMotionAndNoUncertaintyOfIt) {
  std::mt19937 random(kSeed);
  const Belief belief{test::random_state(random), test::random_covariance(random, 0.1)};
  const Belief next = rebased(belief, true);
  EXPECT_EQ(next.state.motion.translation, Eigen::Vector3d::Zero());
  EXPECT_TRUE(next.state.motion.rotation.isApprox(Eigen::Quaterniond::Identity()));
  for (const int block : {Error::kPosition, Error::kRotation}) {
    EXPECT_EQ(next.covariance.middleRows<3>(block).norm(), 0.0);
    EXPECT_EQ(next.covariance.middleCols<3>(block).norm(), 0.0);
  }
  EXPECT_EQ(part(next.covariance, Error::kAccelerometerBias, Error::kAccelerometerBias),
            part(belief.covariance, Error::kAccelerometerBias, Error::kAccelerometerBias));
  EXPECT_EQ(part(next.covariance, Error::kVelocity, Error::kGravity).norm(), 0.0);
}

// A vector fixed in the world has other coordinates in the new axes; so has its covariance.
TEST(LinsState, VelocityAndGravityOfARebasedBeliefAreInTheNewAxes) {
  std::mt19937 random(kSeed);
  const Belief belief{test::random_state(random), test::random_covariance(random, 0.1)};
  const State& x = belief.state;
  const Belief next = rebased(belief, true);
  EXPECT_LT((x.motion.rotation * next.state.velocity - x.velocity).norm(), 1e-12);
  EXPECT_LT((x.motion.rotation * next.state.gravity - x.gravity).norm(), 1e-12);
  const Eigen::Matrix3d R = x.motion.R();
  for (const int block : {Error::kVelocity, Error::kGravity}) {
    const Eigen::Matrix3d back = R * part(next.covariance, block, block) * R.transpose();
    EXPECT_LT((back - part(belief.covariance, block, block)).norm(), 1e-12);
  }
}

TEST(LinsState, GravityKeepsItsLengthAndAsPublishedItsCoordinates) {
  std::mt19937 random(kSeed);
  Belief belief{test::random_state(random), test::random_covariance(random, 0.1)};
  belief.state.gravity *= 1.01;
  const Belief next = rebased(belief, false);
  EXPECT_NEAR(next.state.gravity.norm(), kGravity, 1e-12);
  EXPECT_LT(next.state.gravity.cross(belief.state.gravity).norm(), 1e-9);
}

TEST(LinsState, GravityLevelsTheOrientation) {
  const Eigen::Vector3d down(0.0, 0.0, -kGravity);
  for (const double angle : {-0.4, -0.1, 0.0, 0.2}) {
    for (const Eigen::Vector3d& axis :
         {Eigen::Vector3d(1.0, 0.0, 0.0), Eigen::Vector3d(0.0, 1.0, 0.0)}) {
      const Eigen::Quaterniond R = yaw_rotation(0.7) * so3_exp(angle * axis);
      const Eigen::Quaterniond tilted = R * so3_exp({0.1, 0.2, 0.0});
      const Eigen::Quaterniond heading = yaw_rotation(yaw_of(tilted));
      const Eigen::Vector3d gravity = so3_exp(angle * axis).conjugate() * down;
      const Eigen::Quaterniond level = levelled(tilted, gravity);
      EXPECT_LT(so3_log(level.conjugate() * heading * so3_exp(angle * axis)).norm(), 1e-12);
      // A specific force at rest is opposite to gravity.
      EXPECT_LT(so3_log(level.conjugate() * levelled(tilted, -gravity)).norm(), 1e-12);
    }
  }
}

}  // namespace
}  // namespace aims::lins
