// SPDX-License-Identifier: BSD-3-Clause
#include "recordings/inspection/clock_offset.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "core/random.hpp"

namespace aims {
namespace {

/// A walking trunk: gait on top of turns that come and go.
double rate_at(double t) {
  return 0.3 + 0.2 * std::sin(14.5 * t) + 0.3 * std::pow(std::sin(0.31 * t), 2) * std::cos(2.2 * t);
}

std::vector<TurnRate> measured(double hz, double late_s, double noise_sigma, std::uint64_t seed,
                               double length_s = 60.0) {
  RandomStream noise(seed, "noise");
  std::vector<TurnRate> rates;
  for (int i = 0; i < length_s * hz; ++i) {
    const double t = i / hz;
    rates.push_back({from_seconds(t + late_s), rate_at(t) + noise_sigma * noise.normal()});
  }
  return rates;
}

TEST(ClockOffset, IsExactToAMillisecond) {
  const auto reference = measured(50.0, 0.0, 0.02, 1);
  for (const double late : {-0.120, -0.031, 0.0, 0.008, 0.2, 0.41}) {
    const auto found = clock_offset(measured(200.0, late, 0.05, 2), reference);
    ASSERT_TRUE(found.has_value()) << late;
    EXPECT_NEAR(found->seconds, late, 1e-3);
    EXPECT_GT(found->correlation, 0.8);
  }
}

TEST(ClockOffset, IsAbsentForUncorrelatedSensors) {
  RandomStream noise(3, "noise");
  std::vector<TurnRate> other = measured(200.0, 0.0, 0.0, 1);
  for (TurnRate& each : other) each.rate = std::abs(noise.normal());
  EXPECT_FALSE(clock_offset(other, measured(50.0, 0.0, 0.02, 1)).has_value());
}

TEST(ClockOffset, IsAbsentWithoutMotion) {
  std::vector<TurnRate> still;
  for (int i = 0; i < 4000; ++i) still.push_back({i * 5 * kMillisecond, 0.002});
  EXPECT_FALSE(clock_offset(still, still).has_value());
}

TEST(ClockOffset, IsAbsentForShortRecordings) {
  EXPECT_FALSE(clock_offset({}, {}).has_value());
  const auto brief = measured(200.0, 0.0, 0.01, 1, 5.0);
  EXPECT_FALSE(clock_offset(brief, brief).has_value());
}

}  // namespace
}  // namespace aims
