// SPDX-License-Identifier: BSD-3-Clause
#include "sim/sensors/structural_vibration.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "sim/sensors/low_pass.hpp"

namespace aims {
namespace {

using Loads = std::array<double, kLegCount>;
constexpr double kTimestep = 0.0025;  ///< [s]

/// One mode on one axis each of acceleration and rate, the same in every run.
VibrationConfig one_mode(double frequency, double damping) {
  VibrationConfig config;
  config.level = 1.0;
  config.variation = 0.0;
  config.damping = damping;
  config.modes = {{frequency, {0.0, 0.0, 0.2}, {0.01, 0.0, 0.0}}};
  return config;
}

TEST(SecondOrderSystem, FollowsTheAnalyticStepResponseAtEveryTimestep) {
  const double w = 2.0 * std::numbers::pi * 30.0;
  const double zeta = 0.2;
  const double damped = w * std::sqrt(1.0 - zeta * zeta);
  for (const double step : {0.0005, 0.0025, 0.005}) {
    SecondOrderSystem system(30.0, zeta, step);
    for (int i = 1; i <= 100; ++i) {
      system.step(Eigen::Vector3d::Ones());
      const double t = i * step;
      const double expected =
          1.0 - std::exp(-zeta * w * t) *
                    (std::cos(damped * t) + zeta * w / damped * std::sin(damped * t));
      EXPECT_NEAR(system.position().x(), expected, 1e-9) << step << " s, step " << i;
    }
  }
}

TEST(SecondOrderSystem, StaysBoundedAboveHalfTheStepRate) {
  SecondOrderSystem system(150.0, 0.005, 0.005);
  for (int i = 0; i < 100'000; ++i) {
    system.step(Eigen::Vector3d::Constant(i % 2 == 0 ? 1.0 : -1.0));
    ASSERT_LT(system.band().norm(), 1e3);
  }
}

/// Ratio of output to input amplitude of a sine after the transient.
double gain(LowPass& filter, double frequency, double step) {
  double out = 0.0;
  double in = 0.0;
  for (int i = 0; i < static_cast<int>(4.0 / step); ++i) {
    const double value = std::sin(2.0 * std::numbers::pi * frequency * i * step);
    const double filtered = filter.filter(Eigen::Vector3d::Constant(value)).y();
    if (i * step < 2.0) continue;
    out += filtered * filtered;
    in += value * value;
  }
  return std::sqrt(out / in);
}

TEST(LowPass, AttenuatesASineAsTheAnalyticFilter) {
  const double step = 0.0005;
  for (const double frequency : {1.0, 10.0, 20.0, 60.0}) {
    const double ratio = frequency / 20.0;
    LowPass first(20.0, 1, step);
    EXPECT_NEAR(gain(first, frequency, step), 1.0 / std::hypot(1.0, ratio), 0.01);
    LowPass second(20.0, 2, step);
    EXPECT_NEAR(gain(second, frequency, step), 1.0 / std::sqrt(1.0 + std::pow(ratio, 4)), 0.01);
  }
}

TEST(LowPass, FollowsTheAnalyticStepResponseOfTheFirstOrder) {
  LowPass filter(15.0, 1, kTimestep);
  filter.filter(Eigen::Vector3d::Zero());
  for (int i = 1; i <= 20; ++i) {
    const double expected = 1.0 - std::exp(-2.0 * std::numbers::pi * 15.0 * i * kTimestep);
    EXPECT_NEAR(filter.filter(Eigen::Vector3d::Ones()).x(), expected, 1e-12);
  }
}

TEST(LowPass, WithoutABandwidthPassesEverything) {
  LowPass filter(0.0, 2, kTimestep);
  filter.filter({1.0, 2.0, 3.0});
  EXPECT_EQ(filter.filter({-4.0, 5.0, 6.0}), Eigen::Vector3d(-4.0, 5.0, 6.0));
}

TEST(StructuralVibration, AConstantLoadDoesNothing) {
  StructuralVibration vibration(one_mode(30.0, 0.1), kTimestep, 1);
  for (int i = 0; i < 100; ++i) {
    const Vibration shaken = vibration.step({30.0, 31.0, 32.0, 33.0});
    EXPECT_LT(shaken.acceleration.norm() + shaken.rate.norm(), 1e-9);
  }
}

TEST(StructuralVibration, AForceAtTheModesFrequencyShakesByItsLevel) {
  StructuralVibration vibration(one_mode(20.0, 0.1), 0.0005, 1);
  double acceleration = 0.0;
  double rate = 0.0;
  for (int i = 0; i < 4000; ++i) {
    const double load = 50.0 + 10.0 * std::sin(2.0 * std::numbers::pi * 20.0 * i * 0.0005);
    const Vibration shaken = vibration.step({load, 0.0, 0.0, 0.0});
    EXPECT_EQ(shaken.acceleration.head<2>().norm() + shaken.rate.tail<2>().norm(), 0.0);
    if (i < 2000) continue;
    acceleration = std::max(acceleration, std::abs(shaken.acceleration.z()));
    rate = std::max(rate, std::abs(shaken.rate.x()));
  }
  EXPECT_NEAR(acceleration, 2.0, 0.02);
  EXPECT_NEAR(rate, 0.1, 0.001);
}

TEST(StructuralVibration, AFootfallRingsAtTheModesFrequencyAndDiesOut) {
  const double zeta = 0.1;
  StructuralVibration vibration(one_mode(20.0, zeta), kTimestep, 1);
  std::vector<double> ringing;
  for (int i = 0; i < 400; ++i) {
    const Loads loads = {i < 10 ? 0.0 : 60.0, 0.0, 0.0, 0.0};
    ringing.push_back(vibration.step(loads).acceleration.z());
  }
  const double w = 2.0 * std::numbers::pi * 20.0;
  const double damped = w * std::sqrt(1.0 - zeta * zeta);
  for (int i = 10; i < 400; ++i) {
    // Band-pass 2 zeta / w x' of the step response.
    const double t = (i - 9) * kTimestep;
    const double rate = w * w / damped * std::exp(-zeta * w * t) * std::sin(damped * t);
    EXPECT_NEAR(ringing[i], 0.2 * 60.0 * 2.0 * zeta / w * rate, 1e-9);
  }
  EXPECT_LT(std::abs(ringing.back()), 1e-3);
}

TEST(StructuralVibration, HasOtherSignsInAnotherRunButPushesUpInEach) {
  int changed = 0;
  for (int seed = 1; seed <= 20; ++seed) {
    StructuralVibration vibration(one_mode(20.0, 0.1), kTimestep, seed);
    vibration.step({});
    const Vibration left = vibration.step({40.0, 0.0, 0.0, 0.0});
    EXPECT_GT(left.acceleration.z(), 0.0);
    changed += left.rate.x() > 0.0 ? 1 : 0;
  }
  EXPECT_GT(changed, 3);
  EXPECT_LT(changed, 17);
}

TEST(StructuralVibration, TheFloorHasItsDensityAtEveryTimestep) {
  VibrationConfig config;
  config.floor_acceleration = 0.1;
  config.floor_rate = 0.02;
  for (const double step : {0.0025, 0.0005}) {
    StructuralVibration vibration(config, step, 1);
    Vibration square;
    constexpr int kSteps = 20'000;
    for (int i = 0; i < kSteps; ++i) {
      const Vibration shaken = vibration.step({});
      square.acceleration += shaken.acceleration.cwiseAbs2() / kSteps;
      square.rate += shaken.rate.cwiseAbs2() / kSteps;
    }
    // Up to half the step rate, of which 200 Hz hold the stated deviation.
    const double share = 0.5 / step / 200.0;
    EXPECT_NEAR(square.acceleration.mean(), 0.01 * share, 0.0003 * share);
    EXPECT_NEAR(square.rate.mean(), 4e-4 * share, 1.2e-5 * share);
  }
}

}  // namespace
}  // namespace aims
