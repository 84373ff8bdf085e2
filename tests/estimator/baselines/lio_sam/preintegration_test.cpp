// SPDX-License-Identifier: BSD-3-Clause
#include "estimator/baselines/lio_sam/preintegration.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "core/random.hpp"

namespace aims::lio_sam {
namespace {

using Eigen::Vector3d;

struct Sample {
  Vector3d rate;
  Vector3d force;
};

constexpr double kStep = 0.005;
constexpr double kGravity = 9.80511;

std::vector<Sample> random_samples(int count, std::uint64_t seed) {
  RandomStream random(seed, "preintegration_test");
  std::vector<Sample> samples;
  for (int i = 0; i < count; ++i) {
    samples.push_back({0.8 * random.normal3(), Vector3d(0.5, -0.3, 9.8) + 2.0 * random.normal3()});
  }
  return samples;
}

Preintegration integrated(const std::vector<Sample>& samples, const ImuBias& bias) {
  Preintegration motion;
  motion.bias = bias;
  for (const Sample& each : samples) integrate(motion, each.rate, each.force, kStep, {});
  return motion;
}

/// The state after the samples, step by step in the map.
NavState directly(NavState state, const std::vector<Sample>& samples, const ImuBias& bias) {
  const Vector3d g(0.0, 0.0, -kGravity);
  for (const Sample& each : samples) {
    const Vector3d a = state.T_map_imu.rotation * Vector3d(each.force - bias.accelerometer) + g;
    state.T_map_imu.translation += state.velocity * kStep + 0.5 * a * kStep * kStep;
    state.velocity += a * kStep;
    state.T_map_imu.rotation = state.T_map_imu.rotation * so3_exp((each.rate - bias.gyro) * kStep);
  }
  return state;
}

NavState some_state() { return {{so3_exp({0.1, -0.2, 0.7}), {1.0, -2.0, 0.5}}, {0.8, 0.3, -0.1}}; }

const ImuBias kBias{{0.05, -0.08, 0.1}, {0.01, 0.02, -0.015}};

void expect_near(const NavState& a, const NavState& b, double tolerance) {
  EXPECT_LT((a.T_map_imu.translation - b.T_map_imu.translation).norm(), tolerance);
  EXPECT_LT((a.velocity - b.velocity).norm(), tolerance);
  EXPECT_LT(so3_log(a.T_map_imu.rotation.conjugate() * b.T_map_imu.rotation).norm(), tolerance);
}

TEST(LioSamPreintegration, PredictsWhatDirectIntegrationYields) {
  for (const std::uint64_t seed : {1, 2, 3}) {
    const auto samples = random_samples(60, seed);
    const Preintegration motion = integrated(samples, kBias);
    EXPECT_NEAR(motion.duration, 60 * kStep, 1e-12);
    expect_near(predicted(some_state(), motion, kBias, kGravity),
                directly(some_state(), samples, kBias), 1e-10);
  }
}

TEST(LioSamPreintegration, AtRestNothingMoves) {
  Preintegration motion;
  for (int i = 0; i < 100; ++i) {
    integrate(motion, Vector3d::Zero(), {0.0, 0.0, kGravity}, kStep, {});
  }
  expect_near(predicted(NavState(), motion, ImuBias(), kGravity), NavState(), 1e-10);
}

/// Entries: rotation, velocity, position of the delta at another bias relative to this one.
Eigen::VectorXd difference(const MotionDelta& other, const MotionDelta& delta) {
  Eigen::VectorXd result(9);
  result << so3_log(delta.rotation.conjugate() * other.rotation), other.velocity - delta.velocity,
      other.position - delta.position;
  return result;
}

TEST(LioSamPreintegration, BiasJacobiansMatchFiniteDifferences) {
  const auto samples = random_samples(40, 5);
  const Preintegration motion = integrated(samples, kBias);
  constexpr double kSmall = 1e-6;
  for (int axis = 0; axis < 3; ++axis) {
    ImuBias gyro = kBias;
    gyro.gyro[axis] += kSmall;
    Eigen::VectorXd expected(9);
    expected << motion.rotation_by_gyro.col(axis), motion.velocity_by_gyro.col(axis),
        motion.position_by_gyro.col(axis);
    Eigen::VectorXd found = difference(integrated(samples, gyro).delta, motion.delta) / kSmall;
    EXPECT_LT((found - expected).norm(), 1e-5) << "gyro, axis " << axis;
    ImuBias accelerometer = kBias;
    accelerometer.accelerometer[axis] += kSmall;
    expected << Vector3d::Zero(), motion.velocity_by_accelerometer.col(axis),
        motion.position_by_accelerometer.col(axis);
    found = difference(integrated(samples, accelerometer).delta, motion.delta) / kSmall;
    EXPECT_LT((found - expected).norm(), 1e-5) << "accelerometer, axis " << axis;
  }
}

TEST(LioSamPreintegration, ACorrectionForTheBiasIsOfFirstOrder) {
  const auto samples = random_samples(40, 6);
  const Preintegration motion = integrated(samples, ImuBias());
  const MotionDelta exact = integrated(samples, kBias).delta;
  const double error = difference(corrected(motion, kBias), exact).norm();
  const ImuBias half{0.5 * kBias.accelerometer, 0.5 * kBias.gyro};
  const double half_error =
      difference(corrected(motion, half), integrated(samples, half).delta).norm();
  EXPECT_LT(error, 0.05 * difference(motion.delta, exact).norm());
  EXPECT_NEAR(error / half_error, 4.0, 0.4) << "of second order";
}

TEST(LioSamPreintegration, CovarianceIsThatOfManyNoisyRuns) {
  constexpr std::uint64_t kSeed = 11;
  constexpr int kRuns = 4000;
  RandomStream random(kSeed, "preintegration_noise");
  const auto samples = random_samples(40, 7);
  const ImuNoiseConfig noise{.accelerometer = 0.05, .gyro = 0.02, .integration = 1e-9};
  Preintegration motion;
  for (const Sample& s : samples) integrate(motion, s.rate, s.force, kStep, noise);
  Matrix9 sampled = Matrix9::Zero();
  for (int run = 0; run < kRuns; ++run) {
    Preintegration noisy;
    for (const Sample& s : samples) {
      const double scale = 1.0 / std::sqrt(kStep);
      integrate(noisy, s.rate + noise.gyro * scale * random.normal3(),
                s.force + noise.accelerometer * scale * random.normal3(), kStep, noise);
    }
    const Eigen::VectorXd error = difference(noisy.delta, motion.delta);
    sampled += error * error.transpose() / kRuns;
  }
  const Eigen::VectorXd sigma = motion.covariance.diagonal().cwiseSqrt();
  const Matrix9 scaled = sigma.cwiseInverse().asDiagonal() * (sampled - motion.covariance) *
                         sigma.cwiseInverse().asDiagonal();
  EXPECT_LT(scaled.cwiseAbs().maxCoeff(), 0.1) << "seed " << kSeed;
}

}  // namespace
}  // namespace aims::lio_sam
