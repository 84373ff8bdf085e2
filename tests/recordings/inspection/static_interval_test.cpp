// SPDX-License-Identifier: BSD-3-Clause
#include "recordings/inspection/static_interval.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <utility>

#include "core/random.hpp"

namespace aims {
namespace {

using Eigen::Vector3d;

constexpr double kRate = 100.0;
constexpr double kGyroDensity = 4e-4;   // rad/s/sqrt(Hz)
constexpr double kForceDensity = 3e-3;  // m/s^2/sqrt(Hz)
const Vector3d kBias(0.002, -0.003, 0.001);
const Vector3d kForce(0.1, -0.2, 9.79);

/// Samples of that long, at rest or walking.
void feed(StaticIntervalFinder& finder, RandomStream& noise, double from, double to, bool walking) {
  for (double t = from; t < to - 1e-9; t += 1.0 / kRate) {
    ImuSample sample;
    sample.stamp = from_seconds(t);
    sample.angular_velocity = kBias + kGyroDensity * std::sqrt(kRate) * noise.normal3();
    sample.specific_force = kForce + kForceDensity * std::sqrt(kRate) * noise.normal3();
    if (walking) {
      sample.angular_velocity.y() += 0.3 * std::sin(14.0 * t);
      sample.specific_force.z() += 3.0 * std::sin(14.0 * t);
    }
    finder.add(sample);
  }
}

TEST(StaticIntervalFinder, MeasuresBiasAndNoiseDensity) {
  StaticIntervalFinder finder;
  RandomStream noise(11, "noise");
  feed(finder, noise, 0.0, 20.0, false);
  feed(finder, noise, 20.0, 40.0, true);
  const StaticInterval rest = finder.longest().value();
  EXPECT_NEAR(rest.begin_s, 0.0, 1e-9);
  EXPECT_NEAR(rest.length_s, 20.0, 1.0);
  // Mean of 2000 samples: 4e-3 / sqrt(2000) = 1e-4 rad/s; densities to 1/sqrt(2*2000) = 1.6 %.
  EXPECT_LT((rest.gyro_bias - kBias).norm(), 5e-4);
  EXPECT_LT((rest.force - kForce).norm(), 4e-3);
  for (int axis = 0; axis < 3; ++axis) {
    EXPECT_NEAR(rest.gyro_noise[axis] / kGyroDensity, 1.0, 0.08);
    EXPECT_NEAR(rest.force_noise[axis] / kForceDensity, 1.0, 0.08);
  }
}

TEST(StaticIntervalFinder, BeginsAtTheEarliestStampThoughALaterOneIsReadFirst) {
  StaticIntervalFinder finder;
  RandomStream noise(13, "noise");
  feed(finder, noise, 2.5, 2.5 + 0.5 / kRate, false);
  feed(finder, noise, 0.0, 5.0, false);
  EXPECT_NEAR(finder.longest().value().begin_s, 0.0, 1e-9);
}

TEST(StaticIntervalFinder, FindsTheLongestInterval) {
  StaticIntervalFinder finder;
  RandomStream noise(12, "noise");
  feed(finder, noise, 0.0, 2.0, false);
  feed(finder, noise, 2.0, 6.0, true);
  feed(finder, noise, 6.0, 14.0, false);
  const StaticInterval rest = finder.longest().value();
  EXPECT_NEAR(rest.begin_s, 6.5, 0.6);
  EXPECT_NEAR(rest.length_s, 7.5, 0.6);
}

TEST(StaticIntervalFinder, FindsNoneWhileWalking) {
  StaticIntervalFinder finder;
  RandomStream noise(13, "noise");
  feed(finder, noise, 0.0, 10.0, true);
  EXPECT_FALSE(finder.longest().has_value());
}

TEST(StaticIntervalFinder, ARobotThatLiesDownSlowlyMoves) {
  // A bias of the same size turns no force.
  for (const auto& [turns, hz] : {std::pair(true, 100), {false, 100}, {true, 30}, {false, 30}}) {
    StaticIntervalFinder finder;
    RandomStream noise(15, "noise");
    const int begin = 3 * hz / 2;
    for (int i = 0; i < 4 * hz; ++i) {
      ImuSample sample;
      sample.stamp = i * kSecond / hz;
      const double angle = turns && i >= begin ? -0.09 * (i - begin) / hz : 0.0;
      const double rate = turns && i < begin ? 0.0 : -0.09;
      sample.angular_velocity = Vector3d(0.0, rate, 0.0) + 0.004 * noise.normal3();
      sample.specific_force =
          9.81 * Vector3d(-std::sin(angle), 0.0, std::cos(angle)) + 0.03 * noise.normal3();
      finder.add(sample);
    }
    const StaticInterval rest = finder.longest().value();
    EXPECT_NEAR(rest.length_s, turns ? 1.0 : 4.0, 0.1) << hz;
    EXPECT_NEAR(rest.gyro_bias.y(), turns ? 0.0 : -0.09, 0.003) << hz;
  }
}

TEST(StaticIntervalFinder, ASteadyTurnIsNotStatic) {
  StaticIntervalFinder finder;
  for (int i = 0; i < 500; ++i) {
    finder.add({i * 10 * kMillisecond, Vector3d(0.0, 0.0, 0.5), kForce});
  }
  EXPECT_FALSE(finder.longest().has_value());
}

TEST(StaticIntervalFinder, IgnoresSamplesThatAreNotFinite) {
  StaticIntervalFinder finder;
  for (int i = 0; i < 300; ++i) {
    ImuSample sample{i * 10 * kMillisecond, kBias, kForce};
    if (i % 7 == 0) sample.specific_force.x() = std::nan("");
    finder.add(sample);
  }
  EXPECT_LT((finder.longest().value().force - kForce).norm(), 1e-9);
}

}  // namespace
}  // namespace aims
