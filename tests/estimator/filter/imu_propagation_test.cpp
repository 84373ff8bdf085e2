// SPDX-License-Identifier: BSD-3-Clause
#include "estimator/filter/imu_propagation.hpp"

#include <gtest/gtest.h>

#include "core/random.hpp"
#include "tests/estimator/finite_differences.hpp"

namespace aims {
namespace {

constexpr double kGravity = 9.81;
constexpr ImuNoiseDensity kWhite{3e-3, 0.1};

InertialSegment some_segment() {
  return {0, 20 * kMillisecond, {0.9, -0.7, 1.2}, {3.0, -2.0, 14.0}, true, kWhite};
}

TEST(ImuPropagation, JacobianMatchesFiniteDifferences) {
  const NominalState state = test::some_state();
  const NominalState next = propagate_state(state, some_segment(), 0.02, kGravity);
  const ErrorMatrix numeric =
      test::numeric_jacobian<ErrorState::kSize>(state, [&](const NominalState& moved) {
        return boxminus(propagate_state(moved, some_segment(), 0.02, kGravity), next);
      });
  const ErrorMatrix F = propagation_jacobian(state, some_segment(), 0.02);
  // Terms of third order in the step's angle are left out.
  EXPECT_LT((F - numeric).cwiseAbs().maxCoeff(), 5e-5);
}

TEST(ImuPropagation, TwoHalvesEqualTheWhole) {
  const NominalState state = test::some_state();
  const NominalState whole = propagate_state(state, some_segment(), 0.02, kGravity);
  const NominalState half = propagate_state(state, some_segment(), 0.007, kGravity);
  const NominalState halves = propagate_state(half, some_segment(), 0.013, kGravity);
  EXPECT_LT(boxminus(halves, whole).norm(), 1e-8);
}

TEST(ImuPropagation, BackwardUndoesForward) {
  const NominalState state = test::some_state();
  const NominalState there = propagate_state(state, some_segment(), 0.02, kGravity);
  EXPECT_LT(boxminus(propagate_state(there, some_segment(), -0.02, kGravity), state).norm(), 1e-8);
}

TEST(ImuPropagation, StandingStillStaysAtRest) {
  const InertialSegment rest{0, kSecond, Eigen::Vector3d::Zero(), {0.0, 0.0, kGravity}, true, {}};
  const NominalState next = propagate_state(NominalState{}, rest, 1.0, kGravity);
  EXPECT_LT(boxminus(next, NominalState{}).norm(), 1e-12);
}

TEST(ImuPropagation, CoordinatedTurnFollowsTheCircle) {
  // Forward at 2 m/s while turning at 0.5 rad/s: a circle of 4 m radius.
  const double speed = 2.0;
  const double rate = 0.5;
  const InertialSegment turn{0, kSecond, {0.0, 0.0, rate}, {0.0, speed * rate, kGravity}, true, {}};
  NominalState state;
  state.velocity = {speed, 0.0, 0.0};
  for (int i = 0; i < 100; ++i) state = propagate_state(state, turn, 0.01, kGravity);
  const double radius = speed / rate;
  const Eigen::Vector3d expected(radius * std::sin(rate), radius * (1.0 - std::cos(rate)), 0.0);
  EXPECT_LT((state.position - expected).norm(), 1e-6);
  EXPECT_NEAR(yaw_of(state.rotation), rate, 1e-12);
}

TEST(ImuPropagation, NoiseOfPartsAddsUpToTheNoiseOfTheWhole) {
  const ImuPropagationConfig config;
  const Belief start{test::some_state(), ErrorMatrix::Identity() * 1e-6};
  const Eigen::Vector3d gravity(0.0, 0.0, kGravity);
  const InertialSegment slow{0, kSecond, Eigen::Vector3d::Zero(), gravity, true, kWhite};
  const Belief whole = propagate(start, slow, 0.02, config);
  const Belief parts = propagate(propagate(start, slow, 0.008, config), slow, 0.012, config);
  EXPECT_LT((whole.covariance - parts.covariance).cwiseAbs().maxCoeff(), 1e-8);
}

/// A covariance in which every entry is correlated with every other.
ErrorMatrix some_covariance() {
  RandomStream random(1, "propagation");
  ErrorMatrix A;
  for (double& entry : A.reshaped()) entry = 0.02 * random.normal();
  return A * A.transpose() + 1e-4 * ErrorMatrix::Identity();
}

TEST(ImuPropagation, CovarianceIsThatOfTheDenseProduct) {
  const ImuPropagationConfig config;
  const Belief start{test::some_state(), some_covariance()};
  const ErrorMatrix F = propagation_jacobian(start.state, some_segment(), 0.02);
  const ErrorMatrix dense =
      F * start.covariance * F.transpose() + propagation_noise(config, kWhite, 0.02);
  const Belief next = propagate(start, some_segment(), 0.02, config);
  EXPECT_LT((next.covariance - dense).cwiseAbs().maxCoeff(), 1e-15);
  EXPECT_EQ(next.covariance, ErrorMatrix(next.covariance.transpose()));
}

TEST(ImuPropagation, TheExcessIsPropagatedWithoutNoise) {
  const ErrorMatrix P = some_covariance();
  const Belief start{test::some_state(), P, ErrorMatrix(0.5 * P)};
  const Belief larger{test::some_state(), 1.5 * P};
  const ErrorMatrix stated = stated_covariance(propagate(start, some_segment(), 0.02, {}));
  const ErrorMatrix expected = propagate(larger, some_segment(), 0.02, {}).covariance;
  EXPECT_LT((stated - expected).norm(), 1e-12 * expected.norm());
}

TEST(ImuPropagation, LeavesLegsMountAndDelayAlone) {
  const Belief start{test::some_state(), some_covariance()};
  const Belief next = propagate(start, some_segment(), 0.02, ImuPropagationConfig{});
  constexpr int kRest = ErrorState::kSize - ErrorState::kMotionSize;
  EXPECT_EQ(boxminus(next.state, start.state).tail<kRest>().norm(), 0.0);
  const auto difference = next.covariance - start.covariance;
  EXPECT_LT((difference.bottomRightCorner<kRest, kRest>()).cwiseAbs().maxCoeff(), 1e-17);
}

TEST(ImuPropagation, TheNoiseOfTheSegmentCounts) {
  const Belief start{test::some_state(), ErrorMatrix::Identity() * 1e-6};
  InertialSegment quiet = some_segment();
  quiet.noise = {};
  const ImuPropagationConfig config;
  const ErrorMatrix added = propagate(start, some_segment(), 0.02, config).covariance -
                            propagate(start, quiet, 0.02, config).covariance;
  const int rotation = ErrorState::kRotation.offset;
  const int velocity = ErrorState::kVelocity.offset;
  EXPECT_NEAR(added(rotation, rotation), 0.02 * 3e-3 * 3e-3, 1e-12);
  EXPECT_NEAR(added(velocity, velocity), 0.02 * 0.1 * 0.1, 1e-12);
}

}  // namespace
}  // namespace aims
