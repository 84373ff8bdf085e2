// SPDX-License-Identifier: BSD-3-Clause
#include "estimator/filter/error_state.hpp"

#include <gtest/gtest.h>

#include <limits>

#include "tests/estimator/finite_differences.hpp"

namespace aims {
namespace {

ErrorVector some_error() {
  ErrorVector delta;
  delta << 0.4, -0.3, 0.2, 1.0, 2.0, -1.0, 0.3, 0.1, -0.2, 0.01, 0.02, -0.01, 0.1, -0.1, 0.2, 0.05,
      -0.02, 0.1, 0.01, 0.02, -0.03, 0.3, -0.2, 0.1, 0.002;
  return delta;
}

TEST(ErrorState, BoxminusUndoesBoxplus) {
  const NominalState state = test::some_state();
  const ErrorVector delta = some_error();
  EXPECT_LT((boxminus(boxplus(state, delta), state) - delta).norm(), 1e-12);
}

TEST(ErrorState, PerturbsRotationOnTheRight) {
  const NominalState state = test::some_state();
  const ErrorVector delta = some_error();
  const Eigen::Quaterniond expected = state.rotation * so3_exp(delta.head<3>());
  EXPECT_LT(boxplus(state, delta).rotation.angularDistance(expected), 1e-12);
}

TEST(ErrorState, PerturbsTheMountOnTheLeftAndTheDelayAsANumber) {
  const NominalState state = test::some_state();
  ErrorVector delta = ErrorVector::Zero();
  segment(delta, ErrorState::kMount) << 0.3, -0.2, 0.1;
  delta(ErrorState::kDelay) = 0.002;
  const NominalState moved = boxplus(state, delta);
  const Eigen::Quaterniond expected = so3_exp({0.3, -0.2, 0.1}) * state.mount;
  EXPECT_LT(moved.mount.angularDistance(expected), 1e-12);
  EXPECT_DOUBLE_EQ(moved.delay, state.delay + 0.002);
  EXPECT_LT(moved.rotation.angularDistance(state.rotation), 1e-12);
}

TEST(ErrorState, ItsBlocksCoverItOnce) {
  using State = ErrorState;
  ErrorVector covered = ErrorVector::Zero();
  for (const State::Block each :
       {State::kRotation, State::kPosition, State::kVelocity, State::kGyroBias,
        State::kAccelerometerBias, State::kLegScale, State::kLegBias, State::kMount}) {
    segment(covered, each).array() += 1.0;
  }
  covered(State::kDelay) += 1.0;
  EXPECT_EQ(covered, ErrorVector::Ones());
}

TEST(ErrorState, IsFiniteOnlyWithAFiniteMountAndDelay) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_TRUE(is_finite(test::some_state()));
  NominalState state = test::some_state();
  state.delay = nan;
  EXPECT_FALSE(is_finite(state));
  state = test::some_state();
  state.mount.x() = nan;
  EXPECT_FALSE(is_finite(state));
}

TEST(ErrorState, ResetCovarianceMatchesFiniteDifferences) {
  const NominalState state = test::some_state();
  const NominalState moved = boxplus(state, some_error());
  ErrorMatrix numeric;
  for (int i = 0; i < ErrorState::kSize; ++i) {
    const ErrorVector step = 1e-5 * ErrorVector::Unit(i);
    numeric.col(i) = (boxminus(boxplus(state, some_error() + step), moved) -
                      boxminus(boxplus(state, some_error() - step), moved)) /
                     2e-5;
  }
  const ErrorMatrix root = ErrorMatrix::Random();
  const ErrorMatrix covariance = root * root.transpose();
  EXPECT_LT(
      (reset_covariance(covariance, some_error()) - numeric * covariance * numeric.transpose())
          .cwiseAbs()
          .maxCoeff(),
      1e-7);
}

/// The mean of a prior about another state than its own is minus the offset: the Jacobian of the
/// change of coordinates leaves the offset as it is.
TEST(ErrorState, ResetLeavesTheOffsetAsItIs) {
  const ErrorVector offset = some_error();
  const ErrorMatrix along = reset_covariance(offset * offset.transpose(), offset);
  EXPECT_LT((along - offset * offset.transpose()).cwiseAbs().maxCoeff(), 1e-12);
}

}  // namespace
}  // namespace aims
