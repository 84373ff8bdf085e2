// SPDX-License-Identifier: BSD-3-Clause
#include "estimator/baselines/lins/filter.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/estimator/baselines/lins/random_states.hpp"

namespace aims::lins {
namespace {

constexpr unsigned kSeed = 5;

/// Largest difference between the derivative and finite differences under a steady input.
double jacobian_error(const State& x, const Inertial& input, double dt) {
  constexpr double kStep = 1e-6;
  const State y = predicted(x, input, input, dt);
  const ErrorMatrix F = prediction_jacobian(y, input, dt);
  double largest = 0.0;
  for (int k = 0; k < Error::kSize; ++k) {
    const ErrorVector step = kStep * ErrorVector::Unit(k);
    const ErrorVector slope = (minus(predicted(plus(x, step), input, input, dt), y) -
                               minus(predicted(plus(x, -step), input, input, dt), y)) /
                              (2.0 * kStep);
    largest = std::max(largest, (F.col(k) - slope).cwiseAbs().maxCoeff());
  }
  return largest;
}

// F is taken at the state after the step: it is right up to terms of the second order.
TEST(LinsPrediction, JacobianMatchesFiniteDifferencesToTheFirstOrder) {
  std::mt19937 random(kSeed);
  for (int i = 0; i < 10; ++i) {
    const State x = test::random_state(random);
    const Inertial input = test::random_inertial(random);
    const double coarse = jacobian_error(x, input, 0.004);
    const double fine = jacobian_error(x, input, 0.002);
    EXPECT_LT(coarse, 1e-3) << "seed " << kSeed << ", case " << i;
    EXPECT_NEAR(coarse / fine, 4.0, 0.4) << "seed " << kSeed << ", case " << i;
  }
}

TEST(LinsPrediction, SteadyAccelerationIsExact) {
  State x;
  x.velocity = {1.0, -0.5, 0.2};
  x.gravity = {0.3, 0.1, -9.8};
  x.accelerometer_bias = {0.05, -0.02, 0.01};
  const Eigen::Vector3d acceleration(0.4, 0.2, -0.1);
  const Inertial input{x.gyro_bias, acceleration - x.gravity + x.accelerometer_bias};
  const State after = predicted(x, input, input, 0.5);
  const Eigen::Vector3d moved = 0.5 * x.velocity + 0.125 * acceleration;
  EXPECT_LT((after.motion.translation - moved).norm(), 1e-12);
  EXPECT_LT((after.velocity - x.velocity - 0.5 * acceleration).norm(), 1e-12);
}

/// Distance from the end of a third of a circle, walked in `steps` steps.
double circle_error(int steps) {
  constexpr double kRate = 2.0;    // [rad/s]
  constexpr double kRadius = 1.5;  // [m]
  const double duration = 2.0 * M_PI / 3.0 / kRate;
  State x;
  x.velocity = {kRate * kRadius, 0.0, 0.0};
  const Inertial input{{0.0, 0.0, kRate}, {0.0, kRate * kRate * kRadius, kGravity}};
  for (int i = 0; i < steps; ++i) x = predicted(x, input, input, duration / steps);
  const Eigen::Vector3d end(kRadius * std::sin(2.0 * M_PI / 3.0),
                            kRadius * (1.0 - std::cos(2.0 * M_PI / 3.0)), 0.0);
  EXPECT_LT(so3_log(x.motion.rotation * yaw_rotation(-2.0 * M_PI / 3.0)).norm(), 1e-12);
  return (x.motion.translation - end).norm();
}

TEST(LinsPrediction, ACircleIsRightToTheSecondOrder) {
  EXPECT_LT(circle_error(100), 1e-3);
  EXPECT_NEAR(circle_error(100) / circle_error(200), 4.0, 0.1);
}

// A ramp of rate and force: the mean of both ends is that of the step.
TEST(LinsPrediction, UsesTheMeanOfBothEnds) {
  const Inertial begin{{0.0, 0.0, 0.0}, {0.0, 0.0, kGravity}};
  const Inertial end{{0.0, 0.0, 0.2}, {1.0, 0.0, kGravity}};
  const State after = predicted(State(), begin, end, 0.1);
  EXPECT_NEAR(so3_log(after.motion.rotation).z(), 0.01, 1e-12);
  EXPECT_NEAR(after.velocity.x(), 0.05 * std::cos(0.01), 1e-12);
}

TEST(LinsPrediction, CovarianceFollowsTheJacobianAndTheNoise) {
  std::mt19937 random(kSeed);
  const Belief belief{test::random_state(random), test::random_covariance(random, 0.1)};
  const Inertial begin = test::random_inertial(random);
  const Inertial end = test::random_inertial(random);
  const Belief after = predicted(belief, begin, end, 0.01, {0.1, 0.2, 0.3, 0.4});
  const ErrorMatrix F = prediction_jacobian(after.state, end, 0.01);
  ErrorMatrix expected = F * belief.covariance * F.transpose();
  const auto add = [&](int block, double deviation) {
    part(expected, block, block).diagonal().array() += 1e-4 * deviation * deviation;
  };
  add(Error::kVelocity, 0.1);
  add(Error::kRotation, 0.2);
  add(Error::kAccelerometerBias, 0.3);
  add(Error::kGyroBias, 0.4);
  EXPECT_TRUE(after.covariance.isApprox(expected, 1e-12));
}

}  // namespace
}  // namespace aims::lins
