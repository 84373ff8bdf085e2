// SPDX-License-Identifier: BSD-3-Clause
#include "estimator/filter/error_state.hpp"

#include <gtest/gtest.h>

#include "tests/estimator/finite_differences.hpp"

namespace aims {
namespace {

ErrorVector some_error() {
  ErrorVector delta;
  delta << 0.4, -0.3, 0.2, 1.0, 2.0, -1.0, 0.3, 0.1, -0.2, 0.01, 0.02, -0.01, 0.1, -0.1, 0.2, 0.05,
      -0.02, 0.1, 0.01, 0.02, -0.03;
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

TEST(ErrorState, BoxminusJacobianMatchesFiniteDifferences) {
  const NominalState origin = test::some_state();
  const NominalState state = boxplus(origin, some_error());
  const ErrorMatrix numeric = test::numeric_jacobian<ErrorState::kSize>(
      state, [&](const NominalState& moved) { return boxminus(moved, origin); });
  EXPECT_LT((boxminus_jacobian(test::some_state(), some_error()) - numeric).cwiseAbs().maxCoeff(),
            1e-8);
}

TEST(ErrorState, ResetJacobianMatchesFiniteDifferences) {
  const NominalState state = test::some_state();
  const NominalState moved = boxplus(state, some_error());
  ErrorMatrix numeric;
  for (int i = 0; i < ErrorState::kSize; ++i) {
    const ErrorVector step = 1e-5 * ErrorVector::Unit(i);
    numeric.col(i) = (boxminus(boxplus(state, some_error() + step), moved) -
                      boxminus(boxplus(state, some_error() - step), moved)) /
                     2e-5;
  }
  EXPECT_LT((reset_jacobian(test::some_state(), some_error()) - numeric).cwiseAbs().maxCoeff(),
            1e-8);
}

}  // namespace
}  // namespace aims
