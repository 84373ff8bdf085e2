// SPDX-License-Identifier: BSD-3-Clause
#include "sim/sensors/joint_encoders.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace aims {
namespace {

constexpr Duration kStep = 2'500'000;
constexpr double kAcceleration = 30.0;  ///< of every joint [rad/s^2]

LegOdometryConfig silent() {
  LegOdometryConfig config;
  config.joint_angle_noise = config.joint_rate_noise = 0.0;
  return config;
}

/// Reading after `steps` physics steps of a constant acceleration from rest.
LegOdometrySample accelerated(const LegOdometryConfig& config, int steps) {
  JointEncoders encoders(config, kStep, JointVector::Zero(), 1);
  for (int i = 0; i <= steps; ++i) {
    const double t = i * to_seconds(kStep);
    encoders.update({JointVector::Constant(0.5 * kAcceleration * t * t),
                     JointVector::Constant(kAcceleration * t)});
  }
  LegOdometrySample sample;
  encoders.read(sample);
  return sample;
}

TEST(JointEncoders, WithoutErrorsTheyReadAngleAndRate) {
  const LegOdometrySample sample = accelerated(silent(), 40);
  EXPECT_DOUBLE_EQ(sample.joint_position[5], 0.5 * kAcceleration * 0.01);
  EXPECT_DOUBLE_EQ(sample.joint_velocity[5], kAcceleration * 0.1);
}

TEST(JointEncoders, AnAngleIsAWholeNumberOfSteps) {
  LegOdometryConfig config = silent();
  config.joint_angle_resolution = 7e-3;
  for (int steps = 1; steps < 60; ++steps) {
    const double t = steps * to_seconds(kStep);
    const double angle = accelerated(config, steps).joint_position[0];
    const double count = angle / config.joint_angle_resolution;
    EXPECT_NEAR(count, std::round(count), 1e-9);
    EXPECT_LE(std::abs(angle - 0.5 * kAcceleration * t * t), 3.5e-3 + 1e-12);
  }
}

TEST(JointEncoders, ADifferencedRateIsHalfTheWindowLate) {
  LegOdometryConfig config = silent();
  config.joint_rate_window = 0.02;
  const double rate = accelerated(config, 40).joint_velocity[3];
  EXPECT_NEAR(rate, kAcceleration * (0.1 - 0.01), 1e-9);
}

/// Interpolated where the delay is no whole number of physics steps.
TEST(JointEncoders, AnglesAndRatesAreThoseOfADelayAgo) {
  for (const double delay : {0.005, 0.008, 0.02}) {
    LegOdometryConfig config = silent();
    config.encoder_delay = delay;
    const LegOdometrySample sample = accelerated(config, 40);
    const double then = 0.1 - delay;
    // A chord of the parabola lies at most a h^2 / 8 above it.
    EXPECT_NEAR(sample.joint_position[2], 0.5 * kAcceleration * then * then,
                kAcceleration * 0.0025 * 0.0025 / 8.0 + 1e-12);
    EXPECT_NEAR(sample.joint_velocity[2], kAcceleration * then, 1e-9);
    config.joint_rate_window = 0.01;
    EXPECT_NEAR(accelerated(config, 40).joint_velocity[2], kAcceleration * (then - 0.005), 1e-4);
  }
}

TEST(JointEncoders, BeforeTheDelayHasPassedTheyReadTheFirstMotion) {
  LegOdometryConfig config = silent();
  config.encoder_delay = 0.05;
  EXPECT_DOUBLE_EQ(accelerated(config, 4).joint_position[0], 0.0);
}

TEST(JointEncoders, ACoarseEncoderMakesACoarseRate) {
  LegOdometryConfig config = silent();
  config.joint_rate_window = 0.005;
  config.joint_angle_resolution = 1e-3;
  const double rate = accelerated(config, 13).joint_velocity[0];
  const double count = rate / (config.joint_angle_resolution / config.joint_rate_window);
  EXPECT_NEAR(count, std::round(count), 1e-6);
  EXPECT_NE(count, 0.0);
}

/// The noise of two readings, over the window: sqrt(2) sigma / w.
TEST(JointEncoders, ADifferencedRateHasTheNoiseOfTwoAngles) {
  LegOdometryConfig config = silent();
  config.joint_rate_window = 0.01;
  config.joint_angle_noise = 1e-3;
  JointEncoders encoders(config, kStep, JointVector::Zero(), 5);
  double squares = 0.0;
  constexpr int kReadings = 2000;
  for (int i = 0; i < kReadings; ++i) {
    for (int step = 0; step < 5; ++step) encoders.update({});
    LegOdometrySample sample;
    encoders.read(sample);
    squares += sample.joint_velocity[7] * sample.joint_velocity[7];
  }
  EXPECT_NEAR(std::sqrt(squares / kReadings), std::sqrt(2.0) * 0.1, 0.008) << "seed 5";
}

}  // namespace
}  // namespace aims
