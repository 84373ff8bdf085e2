// SPDX-License-Identifier: BSD-3-Clause
#include "estimator/error_state.hpp"

#include <gtest/gtest.h>

#include "tests/estimator/finite_differences.hpp"

namespace aims {
namespace {

Vector15 some_error() {
  Vector15 delta;
  delta << 0.4, -0.3, 0.2, 1.0, 2.0, -1.0, 0.3, 0.1, -0.2, 0.01, 0.02, -0.01, 0.1, -0.1, 0.2;
  return delta;
}

TEST(ErrorState, BoxminusUndoesBoxplus) {
  const NominalState state = test::some_state();
  const Vector15 delta = some_error();
  EXPECT_LT((boxminus(boxplus(state, delta), state) - delta).norm(), 1e-12);
}

TEST(ErrorState, PerturbsRotationOnTheRight) {
  const NominalState state = test::some_state();
  const Vector15 delta = some_error();
  const Eigen::Quaterniond expected = state.rotation * so3_exp(delta.head<3>());
  EXPECT_LT(boxplus(state, delta).rotation.angularDistance(expected), 1e-12);
}

TEST(ErrorState, BoxminusJacobianMatchesFiniteDifferences) {
  const NominalState origin = test::some_state();
  const NominalState state = boxplus(origin, some_error());
  const Matrix15 numeric = test::numeric_jacobian<15>(
      state, [&](const NominalState& moved) { return boxminus(moved, origin); });
  EXPECT_LT((boxminus_jacobian(some_error()) - numeric).cwiseAbs().maxCoeff(), 1e-8);
}

TEST(ErrorState, ResetJacobianMatchesFiniteDifferences) {
  const NominalState state = test::some_state();
  const NominalState moved = boxplus(state, some_error());
  Matrix15 numeric;
  for (int i = 0; i < 15; ++i) {
    const Vector15 step = 1e-5 * Vector15::Unit(i);
    numeric.col(i) = (boxminus(boxplus(state, some_error() + step), moved) -
                      boxminus(boxplus(state, some_error() - step), moved)) /
                     2e-5;
  }
  EXPECT_LT((reset_jacobian(some_error()) - numeric).cwiseAbs().maxCoeff(), 1e-8);
}

}  // namespace
}  // namespace aims
