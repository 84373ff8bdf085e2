// SPDX-License-Identifier: BSD-3-Clause
#include "estimator/filter/imu_noise.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "core/random.hpp"

namespace aims {
namespace {

constexpr double kRateSigma = 0.1;   // of one sample [rad/s]
constexpr double kForceSigma = 2.0;  // of one sample [m/s^2]

Time stamp_at(int i, double rate_hz) { return from_seconds(i / rate_hz); }

/// Sample `i` of white noise about gravity.
ImuSample white_sample(int i, double rate_hz, RandomStream& random) {
  return {stamp_at(i, rate_hz), kRateSigma * random.normal3(),
          Eigen::Vector3d(0.0, 0.0, 9.81) + kForceSigma * random.normal3()};
}

/// Sample `i` of a body at rest.
ImuSample rest_sample(int i, double rate_hz) {
  return {stamp_at(i, rate_hz), Eigen::Vector3d::Zero(), {0.0, 0.0, 9.81}};
}

TEST(ImuNoise, WhiteNoiseHasItsDensityAtAnyRate) {
  for (const double rate : {50.0, 200.0, 1000.0}) {
    RandomStream random(1, "imu_noise");
    ImuNoise noise(rate);
    double gyro = 0.0;
    double force = 0.0;
    int count = 0;
    for (int i = 0; i < 20.0 * rate; ++i) {
      noise.add(white_sample(i, rate, random));
      if (i < 2.0 * rate) continue;
      gyro += noise.density().gyro;
      force += noise.density().accelerometer;
      ++count;
    }
    EXPECT_NEAR(gyro / count / (kRateSigma / std::sqrt(rate)), 1.0, 0.15) << rate << " Hz";
    EXPECT_NEAR(force / count / (kForceSigma / std::sqrt(rate)), 1.0, 0.15) << rate << " Hz";
  }
}

TEST(ImuNoise, ATrotIsNoWhiteNoise) {
  constexpr double kSampleRate = 50.0;
  constexpr double kSwayRate = 0.3;  // [rad/s]
  constexpr double kBob = 1.5;       // [m/s^2]
  ImuNoise noise(kSampleRate);
  double worst_rate = 0.0;
  double worst_force = 0.0;
  for (int i = 0; i < 500; ++i) {
    const double phase = 2.0 * M_PI * 2.5 * i / kSampleRate;
    noise.add({stamp_at(i, kSampleRate),
               kSwayRate * Eigen::Vector3d(std::sin(phase), std::cos(phase), 0.0),
               {0.0, kBob * std::cos(phase), 9.81 + kBob * std::sin(phase)}});
    worst_rate = std::max(worst_rate, noise.white().rate);
    worst_force = std::max(worst_force, noise.white().force);
  }
  const double deviation = std::sqrt(1.0 / 3.0);  // mean over the axes, of two sines
  EXPECT_LT(worst_rate, 0.1 * deviation * kSwayRate);
  EXPECT_LT(worst_force, 0.1 * deviation * kBob);
}

TEST(ImuNoise, AVibrationCountsWithinFourSamples) {
  constexpr double kSampleRate = 50.0;
  constexpr int kDraws = 200;
  double gyro = 0.0;
  double force = 0.0;
  for (int draw = 0; draw < kDraws; ++draw) {
    RandomStream random(static_cast<std::uint64_t>(draw), "imu_noise.onset");
    ImuNoise noise(kSampleRate);
    for (int i = 0; i < 100; ++i) noise.add(rest_sample(i, kSampleRate));
    for (int i = 100; i < 104; ++i) noise.add(white_sample(i, kSampleRate, random));
    gyro += noise.density().gyro / kDraws;
    force += noise.density().accelerometer / kDraws;
  }
  EXPECT_GT(gyro, 0.5 * kRateSigma / std::sqrt(kSampleRate)) << "seeds 0 to 199";
  EXPECT_GT(force, 0.5 * kForceSigma / std::sqrt(kSampleRate)) << "seeds 0 to 199";
}

TEST(ImuNoise, LostSamplesAreNoVibration) {
  constexpr double kSampleRate = 50.0;
  ImuNoise noise(kSampleRate);
  int at = 0;
  for (int stretch = 0; stretch < 20; ++stretch) {
    for (int i = 0; i < 10; ++i, ++at) {
      ImuSample sample = rest_sample(at, kSampleRate);
      sample.angular_velocity.x() = stretch % 2;
      sample.specific_force.x() = 5.0 * (stretch % 2);
      noise.add(sample);
    }
    at += 3;  // lost
  }
  EXPECT_EQ(noise.white().rate, 0.0);
  EXPECT_NEAR(noise.white().force, 0.0, 1e-12);
  EXPECT_GT(noise.bridge_density().gyro, 0.05) << "the motion itself is unknown in a gap";
}

TEST(ImuNoise, OneLostSampleIsNoVibration) {
  constexpr double kSampleRate = 50.0;
  ImuNoise noise(kSampleRate);
  for (int i = 0; i < 200; ++i) {
    ImuSample sample = rest_sample(i, kSampleRate);
    sample.angular_velocity.x() = 0.2 * i;  // a steady acceleration
    if (i % 7 != 0) noise.add(sample);
  }
  EXPECT_NEAR(noise.white().rate, 0.0, 1e-9);
}

/// One axis of the integral of the IMU, corrected ten times a second by a filter that takes the
/// estimated density for true.
class Axis {
 public:
  Axis(double density, double measured) : density_(density), measured_(measured) {}

  void move(double dt, double assumed, RandomStream& random) {
    error_ += density_ * std::sqrt(dt) * random.normal();
    variance_ += assumed * assumed * dt;
  }

  /// The correction by a measurement.
  double correct(RandomStream& random) {
    const double gain = variance_ / (variance_ + measured_ * measured_);
    const double correction = gain * (error_ + measured_ * random.normal());
    error_ -= correction;
    variance_ *= 1.0 - gain;
    return correction;
  }

 private:
  double density_;
  double measured_;  ///< deviation of a measurement
  double error_ = 0.0;
  double variance_ = 1e-4;
};

// The filter's own correction feeds back on the density that it assumes; it must settle at the true
// one whether the first guess is too large or too small.
TEST(ImuNoise, CorrectionsLeadToTheShareOfTheWhitePartThatIsNoise) {
  constexpr double kSampleRate = 50.0;
  for (const double share : {0.1, 1.0, 4.0}) {
    RandomStream random(3, "imu_noise.share");
    ImuNoise noise(kSampleRate);
    const double gyro_density = std::sqrt(share / kSampleRate) * kRateSigma;
    const double force_density = std::sqrt(share / kSampleRate) * kForceSigma;
    Axis rotation(gyro_density, 2e-3);
    Axis velocity(force_density, 0.1);
    double gyro = 0.0;
    double force = 0.0;
    for (int i = 0; i < 20000; ++i) {
      noise.add(white_sample(i, kSampleRate, random));
      rotation.move(1.0 / kSampleRate, noise.density().gyro, random);
      velocity.move(1.0 / kSampleRate, noise.density().accelerometer, random);
      if (i % 5 != 4) continue;
      const double turn = rotation.correct(random);
      const double push = velocity.correct(random);
      noise.add_correction(turn * turn, push * push, 0.1);
      if (i < 10000) continue;
      gyro += noise.density().gyro / 2000.0;
      force += noise.density().accelerometer / 2000.0;
    }
    EXPECT_NEAR(gyro / gyro_density, 1.0, 0.15) << "share " << share << ", seed 3";
    EXPECT_NEAR(force / force_density, 1.0, 0.15) << "share " << share << ", seed 3";
  }
}

}  // namespace
}  // namespace aims
