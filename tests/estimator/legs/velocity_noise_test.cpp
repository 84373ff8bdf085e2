// SPDX-License-Identifier: BSD-3-Clause
#include "estimator/legs/velocity_noise.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "core/random.hpp"

namespace aims {
namespace {

using Eigen::Vector3d;
constexpr Duration kLegPeriod = kSecond / 200;
constexpr int kScanEvery = 20;
constexpr double kSpeed = 0.7;  // [m/s]

/// A base that walks along its x axis, at a heading, with velocities that `error` (in base axes, of
/// the time in seconds) falsifies; `lost`: no packets at that time.
template <class Error, class Lost>
VelocityNoise after_walk(double duration, bool measured, Error&& error, Lost&& lost) {
  const Eigen::Quaterniond R(Eigen::AngleAxisd(0.8, Vector3d::UnitZ()));
  const Vector3d velocity = R * Vector3d(kSpeed, 0.0, 0.0);
  VelocityNoise noise;
  Vector3d position = Vector3d::Zero();
  const auto steps = static_cast<int>(duration * 200.0);
  for (int i = 0; i < steps; ++i) {
    const Time stamp = i * kLegPeriod;
    const double t = to_seconds(stamp);
    if (!lost(t)) noise.add(stamp, velocity + R * error(t));
    position += to_seconds(kLegPeriod) * velocity;
    if (i % kScanEvery != kScanEvery - 1) continue;
    Pose base;
    base.rotation = R;
    base.translation = position;
    noise.at_scan(stamp + kLegPeriod, base, measured);
  }
  return noise;
}

constexpr auto kNever = [](double) { return false; };

TEST(VelocityNoise, OfWhiteNoiseIsItsDensityAlongEachAxis) {
  RandomStream random = rng(1, "white");
  const Vector3d sigma(0.4, 0.2, 0.1);
  const VelocityNoise noise = after_walk(
      600.0, true, [&](double) -> Vector3d { return sigma.cwiseProduct(random.normal3()); },
      kNever);
  for (int axis = 0; axis < 3; ++axis) {
    const double density = sigma[axis] * sigma[axis] / 200.0;
    EXPECT_NEAR(noise.density()[axis] / density, 1.0, 0.6) << axis;  // 30 windows: 26 %
  }
}

// What alternates with the strides is no error of the way.
TEST(VelocityNoise, OfAStrideIsNone) {
  const VelocityNoise noise = after_walk(
      60.0, true,
      [](double t) -> Vector3d {
        return {0.2 * std::sin(2.0 * std::numbers::pi * t / 0.25), 0.0, 0.0};
      },
      kNever);
  EXPECT_LT(noise.density().x(), 1e-6);
}

// A speed that wanders over seconds counts by what it does to the way.
TEST(VelocityNoise, OfASlowErrorIsLarge) {
  const VelocityNoise noise = after_walk(
      120.0, true,
      [](double t) -> Vector3d {
        return {0.1 * std::sin(2.0 * std::numbers::pi * t / 8.0), 0.0, 0.0};
      },
      kNever);
  EXPECT_NEAR(noise.density().x(), 0.5 * 0.1 * 0.1, 0.2 * 0.5 * 0.1 * 0.1);
  EXPECT_LT(noise.density().y(), 1e-9);
}

TEST(VelocityNoise, IsLearnedOnlyWhereScansMeasureTheWay) {
  const auto wrong = [](double) -> Vector3d { return {0.3, 0.0, 0.0}; };
  EXPECT_EQ(after_walk(60.0, false, wrong, kNever).density(), Vector3d::Zero());
  EXPECT_EQ(after_walk(10.0, true, wrong, kNever).density(), Vector3d::Zero()) << "too few windows";
  EXPECT_GT(after_walk(60.0, true, wrong, kNever).density().x(), 0.05);
}

TEST(VelocityNoise, TakesNothingFromTheTimeOfLostPackets) {
  const auto none = [](double) -> Vector3d { return Vector3d::Zero(); };
  // Losses of 0.3 s every 5 s: the way over them is not known.
  const auto lost = [](double t) { return std::fmod(t, 5.0) > 4.7; };
  EXPECT_LT(after_walk(120.0, true, none, lost).density().x(), 1e-6);
}

}  // namespace
}  // namespace aims
