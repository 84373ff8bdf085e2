// SPDX-License-Identifier: BSD-3-Clause
#include "estimator/baselines/fast_lio2/prediction.hpp"

#include <gtest/gtest.h>

#include "tests/estimator/baselines/fast_lio2/random_states.hpp"

namespace aims::fast_lio2 {
namespace {

constexpr unsigned kSeed = 5;
constexpr double kPeriod = 0.02;

Inertial random_inertial(std::mt19937& random) {
  return {test::random_vector(random, 1.0), test::random_vector(random, 5.0)};
}

TEST(FastLio2Prediction, JacobianMatchesFiniteDifferences) {
  constexpr double kStep = 1e-6;
  std::mt19937 random(kSeed);
  for (int i = 0; i < 10; ++i) {
    const State x = test::random_state(random);
    const Inertial input = random_inertial(random);
    const ErrorMatrix F = prediction_jacobian(x, input, kPeriod);
    const State y = predicted(x, input, kPeriod);
    for (int k = 0; k < Error::kSize; ++k) {
      const ErrorVector step = kStep * ErrorVector::Unit(k);
      const ErrorVector slope = (minus(predicted(plus(x, step), input, kPeriod), y) -
                                 minus(predicted(plus(x, -step), input, kPeriod), y)) /
                                (2.0 * kStep);
      EXPECT_LT((F.col(k) - slope).norm(), 1e-7) << "seed " << kSeed << ", column " << k;
    }
  }
}

// Noise of the rate enters the rotation, that of the force the velocity.
TEST(FastLio2Prediction, NoiseMatchesFiniteDifferences) {
  constexpr double kStep = 1e-6;
  std::mt19937 random(kSeed);
  const State x = test::random_state(random);
  const Inertial input = random_inertial(random);
  const State y = predicted(x, input, kPeriod);
  ErrorMatrix expected = ErrorMatrix::Zero();
  for (int k = 0; k < 3; ++k) {
    Inertial rate = input;
    rate.rate(k) += kStep;
    Inertial force = input;
    force.force(k) += kStep;
    const ErrorVector by_rate = minus(predicted(x, rate, kPeriod), y) / kStep;
    const ErrorVector by_force = minus(predicted(x, force, kPeriod), y) / kStep;
    expected += 0.1 * by_rate * by_rate.transpose() + 0.2 * by_force * by_force.transpose();
  }
  part(expected, Error::kGyroBias, Error::kGyroBias).diagonal().array() += 0.3 * kPeriod * kPeriod;
  part(expected, Error::kAccelerometerBias, Error::kAccelerometerBias).diagonal().array() +=
      0.4 * kPeriod * kPeriod;
  const ErrorMatrix Q = prediction_noise(x, input, kPeriod, {0.1, 0.2, 0.3, 0.4});
  EXPECT_LT((Q - expected).norm(), 1e-8) << "seed " << kSeed;
}

TEST(FastLio2Prediction, ARobotAtRestStays) {
  std::mt19937 random(kSeed);
  State x = test::random_state(random);
  x.velocity.setZero();
  const Inertial input{x.gyro_bias,
                       x.accelerometer_bias - x.T_world_body.rotation.conjugate() * x.gravity};
  EXPECT_LT(minus(predicted(x, input, 1.0), x).norm(), 1e-9) << "seed " << kSeed;
}

TEST(FastLio2Prediction, CovarianceIsPropagatedByTheJacobian) {
  std::mt19937 random(kSeed);
  const Belief belief{test::random_state(random), test::random_covariance(random, 0.1)};
  const Inertial input = random_inertial(random);
  const ProcessNoise noise;
  const Belief after = predicted(belief, input, kPeriod, noise);
  const ErrorMatrix F = prediction_jacobian(belief.state, input, kPeriod);
  const ErrorMatrix Q = prediction_noise(belief.state, input, kPeriod, noise);
  EXPECT_TRUE(after.covariance.isApprox(F * belief.covariance * F.transpose() + Q, 1e-12));
}

}  // namespace
}  // namespace aims::fast_lio2
