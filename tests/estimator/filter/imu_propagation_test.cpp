// SPDX-License-Identifier: BSD-3-Clause
#include "estimator/filter/imu_propagation.hpp"

#include <gtest/gtest.h>

#include "tests/estimator/finite_differences.hpp"

namespace aims {
namespace {

constexpr double kGravity = 9.81;

InertialSegment some_segment() {
  return {0, 20 * kMillisecond, {0.9, -0.7, 1.2}, {3.0, -2.0, 14.0}, true};
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
  const InertialSegment rest{0, kSecond, Eigen::Vector3d::Zero(), {0.0, 0.0, kGravity}, true};
  const NominalState next = propagate_state(NominalState{}, rest, 1.0, kGravity);
  EXPECT_LT(boxminus(next, NominalState{}).norm(), 1e-12);
}

TEST(ImuPropagation, CoordinatedTurnFollowsTheCircle) {
  // Forward at 2 m/s while turning at 0.5 rad/s: a circle of 4 m radius.
  const double speed = 2.0;
  const double rate = 0.5;
  const InertialSegment turn{0, kSecond, {0.0, 0.0, rate}, {0.0, speed * rate, kGravity}, true};
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
  const InertialSegment slow{0, kSecond, Eigen::Vector3d::Zero(), {0.0, 0.0, kGravity}, true};
  const Belief whole = propagate(start, slow, 0.02, config);
  const Belief parts = propagate(propagate(start, slow, 0.008, config), slow, 0.012, config);
  EXPECT_LT((whole.covariance - parts.covariance).cwiseAbs().maxCoeff(), 1e-8);
}

TEST(ImuPropagation, BridgedSpansAreLessCertain) {
  const ImuPropagationConfig config;
  const ErrorMatrix measured = propagation_noise(config, true, 0.02);
  const ErrorMatrix bridged = propagation_noise(config, false, 0.02);
  EXPECT_TRUE((bridged.diagonal().array() >= measured.diagonal().array()).all());
  EXPECT_GT(bridged.trace(), 10.0 * measured.trace());
}

}  // namespace
}  // namespace aims
