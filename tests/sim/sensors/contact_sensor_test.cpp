// SPDX-License-Identifier: BSD-3-Clause
#include "sim/sensors/contact_sensor.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace aims {
namespace {

constexpr Duration kStep = 2'500'000;
constexpr double kDt = 0.0025;  ///< [s]
constexpr double kLoad = 60.0;  ///< of a standing foot [N]

LegOdometryConfig silent() {
  LegOdometryConfig config;
  config.load_noise = config.contact_debounce = 0.0;
  return config;
}

FootLoads all(double load) { return {load, load, load, load}; }

TEST(ContactSensor, ItFollowsARisingLoadWithItsRiseTime) {
  LegOdometryConfig config = silent();
  config.load_rise_time = 0.02;
  config.load_fall_time = 0.5;
  ContactSensor sensor(config, kStep, 1);
  sensor.begin(all(0.0));
  for (int i = 1; i <= 20; ++i) {
    sensor.update(all(kLoad));
    EXPECT_NEAR(sensor.load(2), kLoad * (1.0 - std::exp(-i * kDt / 0.02)), 1e-9);
  }
}

TEST(ContactSensor, ItKeepsALoadForTheHoldAndThenFallsWithItsFallTime) {
  LegOdometryConfig config = silent();
  config.load_rise_time = 0.5;
  config.load_hold = 0.02;
  config.load_fall_time = 0.025;
  ContactSensor sensor(config, kStep, 1);
  sensor.begin(all(kLoad));
  for (int i = 1; i <= 30; ++i) {
    sensor.update(all(0.0));
    const double falling = std::max(0.0, i * kDt - 0.02);
    EXPECT_NEAR(sensor.load(1), kLoad * std::exp(-falling / 0.025), 1e-9) << i;
  }
}

/// What an unloaded sensor reads is in the measured load, not in the detection.
TEST(ContactSensor, EachUnloadedSensorReadsItsOwnPartOfTheLargestZero) {
  LegOdometryConfig config = silent();
  config.load_zero = 40.0;
  double sum = 0.0;
  constexpr int kRuns = 300;
  for (int seed = 1; seed <= kRuns; ++seed) {
    ContactSensor sensor(config, kStep, seed);
    sensor.begin(all(0.0));
    sensor.update(all(0.0));
    for (const bool contact : sensor.detect(kDt)) EXPECT_FALSE(contact) << "seed " << seed;
    EXPECT_NE(sensor.measured()[0], sensor.measured()[1]);
    for (const double zero : sensor.measured()) {
      EXPECT_GE(zero, 0.0);
      EXPECT_LE(zero, 40.0);
      sum += zero;
    }
  }
  EXPECT_NEAR(sum / (4 * kRuns), 20.0, 1.0) << "seeds 1 to 300";
}

TEST(ContactSensor, MeasuredLoadsAreThoseThatDecide) {
  LegOdometryConfig config = silent();
  config.load_noise = 5.0;
  ContactSensor sensor(config, kStep, 3);
  sensor.begin(all(15.0));
  std::array<bool, kLegCount> contact{};
  int changes = 0;
  for (int i = 0; i < 500; ++i) {
    sensor.update(all(15.0));
    const auto detected = sensor.detect(kDt);
    for (std::size_t leg = 0; leg < contact.size(); ++leg) {
      const double limit = contact[leg] ? config.contact_off : config.contact_on;
      EXPECT_EQ(detected[leg], sensor.measured()[leg] > limit) << "seed 3";
      changes += detected[leg] != contact[leg] ? 1 : 0;
    }
    contact = detected;
  }
  EXPECT_GT(changes, 50);
}

TEST(ContactSensor, ALateSensorReadsTheLoadOfThen) {
  LegOdometryConfig config = silent();
  config.load_latency = 0.01;
  ContactSensor sensor(config, kStep, 1);
  sensor.begin(all(0.0));
  for (int i = 1; i <= 40; ++i) {
    sensor.update(all(i));
    EXPECT_DOUBLE_EQ(sensor.load(0), std::max(0, i - 4));
  }
}

/// Time [s] from the beginning of a loading that rises and falls at 2 kN/s to 60 N until contact
/// is detected, and from the beginning of the fall until it is lost.
std::pair<double, double> contact_times(const LegOdometryConfig& config) {
  ContactSensor sensor(config, kStep, 1);
  sensor.begin(all(0.0));
  std::pair<double, double> times = {-1.0, -1.0};
  for (int i = 1; i <= 200; ++i) {
    const double t = i * kDt;
    sensor.update(
        all(t < 0.25 ? std::min(kLoad, 2000.0 * t) : std::max(0.0, kLoad - 2000.0 * (t - 0.25))));
    const bool contact = sensor.detect(kDt)[1];
    if (contact && times.first < 0.0) times.first = t;
    if (!contact && times.first > 0.0 && times.second < 0.0) times.second = t - 0.25;
  }
  return times;
}

TEST(ContactSensor, ALowThresholdHoldsTheContactLonger) {
  LegOdometryConfig low = silent();
  low.contact_on = low.contact_off = 8.0;
  LegOdometryConfig high = silent();
  high.contact_on = high.contact_off = 50.0;
  EXPECT_LT(contact_times(low).first, contact_times(high).first);
  EXPECT_GT(contact_times(low).second, contact_times(high).second);
  EXPECT_NEAR(contact_times(high).first, 50.0 / 2000.0, kDt);
  EXPECT_NEAR(contact_times(high).second, 10.0 / 2000.0, 2.0 * kDt);
}

/// After 60 N the response needs tau ln(60 / threshold) to fall to the threshold.
TEST(ContactSensor, ASlowSensorReportsAFootThatHasLeft) {
  LegOdometryConfig config = silent();
  config.contact_on = config.contact_off = 15.0;
  const double prompt = contact_times(config).second;
  config.load_fall_time = 0.03;
  EXPECT_NEAR(contact_times(config).second - prompt, 0.03 * std::log(4.0), 0.015);
}

TEST(ContactSensor, ItsErrorsAreThoseOfTheRobot) {
  LegOdometryConfig config = silent();
  config.load_offset = 6.0;
  config.load_scale_error = 0.2;
  config.load_zero = 30.0;
  const auto reading = [&config](RunSeeds seeds) {
    ContactSensor sensor(config, kStep, seeds);
    sensor.begin(all(kLoad));
    sensor.detect(kDt);
    return sensor.measured();
  };
  EXPECT_EQ(reading({1, 7}), reading({2, 7}));
  EXPECT_EQ(reading({1, 7}), reading(7));
  EXPECT_NE(reading({1, 7}), reading({1, 8}));
}

TEST(ContactSensor, EachSensorHasItsOwnOffsetAndScale) {
  LegOdometryConfig config = silent();
  config.load_offset = 6.0;
  config.load_scale_error = 0.2;
  double offsets = 0.0;
  double scales = 0.0;
  constexpr int kRuns = 300;
  for (int seed = 1; seed <= kRuns; ++seed) {
    ContactSensor sensor(config, kStep, seed);
    sensor.begin(all(0.0));
    const FootLoads offset = {sensor.load(0), sensor.load(1), sensor.load(2), sensor.load(3)};
    EXPECT_NE(offset[0], offset[1]);
    sensor.begin(all(kLoad));
    for (int leg = 0; leg < kLegCount; ++leg) {
      const double scale = (sensor.load(leg) - offset[leg]) / kLoad - 1.0;
      offsets += offset[leg] * offset[leg];
      scales += scale * scale;
    }
  }
  EXPECT_NEAR(std::sqrt(offsets / (4 * kRuns)), 6.0, 0.5) << "seeds 1 to 300";
  EXPECT_NEAR(std::sqrt(scales / (4 * kRuns)), 0.2, 0.017) << "seeds 1 to 300";
}

}  // namespace
}  // namespace aims
