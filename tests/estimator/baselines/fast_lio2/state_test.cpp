// SPDX-License-Identifier: BSD-3-Clause
#include "estimator/baselines/fast_lio2/state.hpp"

#include <gtest/gtest.h>

#include "tests/estimator/baselines/fast_lio2/random_states.hpp"

namespace aims::fast_lio2 {
namespace {

constexpr unsigned kSeed = 3;

TEST(FastLio2State, MinusUndoesPlus) {
  std::mt19937 random(kSeed);
  for (int i = 0; i < 50; ++i) {
    const State x = test::random_state(random);
    const ErrorVector error = test::random_error(random, 0.3);
    EXPECT_TRUE(minus(plus(x, error), x).isApprox(error, 1e-9)) << "seed " << kSeed;
    const State y = test::random_state(random);
    EXPECT_LT(minus(plus(x, minus(y, x)), y).norm(), 1e-7) << "seed " << kSeed;
  }
}

TEST(FastLio2State, TransportMatchesFiniteDifferences) {
  constexpr double kStep = 1e-6;
  std::mt19937 random(kSeed);
  for (int i = 0; i < 10; ++i) {
    const State origin = test::random_state(random);
    const ErrorVector error = test::random_error(random, 0.3);
    const State x = plus(origin, error);
    const ErrorMatrix J = Transport(origin, x, error) * ErrorMatrix(ErrorMatrix::Identity());
    for (int k = 0; k < Error::kSize; ++k) {
      const ErrorVector step = kStep * ErrorVector::Unit(k);
      const ErrorVector slope =
          (minus(plus(origin, error + step), x) - minus(plus(origin, error - step), x)) /
          (2.0 * kStep);
      EXPECT_LT((J.col(k) - slope).norm(), 1e-7) << "seed " << kSeed << ", column " << k;
    }
  }
}

TEST(FastLio2State, TransportActsAlikeOnVectorsRowsAndColumns) {
  std::mt19937 random(kSeed);
  const State origin = test::random_state(random);
  const ErrorVector error = test::random_error(random, 0.3);
  const Transport transport(origin, plus(origin, error), error);
  const ErrorMatrix J = transport * ErrorMatrix(ErrorMatrix::Identity());
  const ErrorMatrix P = test::random_covariance(random, 0.2);
  EXPECT_TRUE((transport * error).isApprox(J * error, 1e-12));
  EXPECT_TRUE(transport.on_columns(P).isApprox(P * J.transpose(), 1e-12));
  EXPECT_TRUE(transport.of_covariance(P).isApprox(J * P * J.transpose(), 1e-12));
}

TEST(FastLio2State, WhatIsNotFiniteIsNoticed) {
  std::mt19937 random(kSeed);
  State x = test::random_state(random);
  EXPECT_TRUE(is_finite(x));
  x.accelerometer_bias.y() = std::numeric_limits<double>::quiet_NaN();
  EXPECT_FALSE(is_finite(x));
}

}  // namespace
}  // namespace aims::fast_lio2
