// SPDX-License-Identifier: BSD-3-Clause
#include "sim/sensors/scan_pattern.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <complex>
#include <numbers>

#include "core/angle.hpp"
#include "core/lie.hpp"

namespace aims {
namespace {

constexpr double kTurn = 2.0 * std::numbers::pi;

double degrees(double angle) { return angle / kRadiansPerDegree; }

/// Four channels in an order of their own, columns of 55 us.
LidarConfig four_channels() {
  LidarConfig config;
  config.column_interval_us = 55.0;
  config.table.elevations_deg = {-10.0, 5.0, -3.0, 15.0};
  config.table.azimuth_offsets_deg = {1.0, -2.0, 3.0, -4.0};
  config.table.firing_delays_us = {0.0, 20.0, 10.0, 10.0};
  return config;
}

LidarConfig rosette() {
  LidarConfig config;
  config.pattern = LidarPattern::kRosette;
  config.rosette.point_rate = 2e5;
  config.rosette.prism_deflections_deg = {67.5, 26.5};
  config.rosette.prism_rates = {-182.43, -172.71};
  config.rosette.line_offsets_deg = {-3.0, -1.0, 1.0, 3.0};
  config.rosette.line_azimuth_deg = 89.0;
  return config;
}

TEST(ScanPattern, UniformRingsTurnOnceAScan) {
  const ScanPattern pattern(LidarConfig{});
  EXPECT_TRUE(pattern.repeats());
  const auto firings = pattern.firings(7);
  ASSERT_EQ(firings.size(), 28'800U);
  for (std::size_t i = 0; i < firings.size(); ++i) {
    const double time = static_cast<double>(i / 16) * 1e8 / 1800.0 + 2304.0 * (i % 16);
    ASSERT_EQ(firings[i].ring, static_cast<int>(i % 16));
    ASSERT_NEAR(firings[i].time_offset_ns, time, 1e-6);
    ASSERT_NEAR(degrees(firings[i].beam.elevation), -15.0 + 2.0 * (i % 16), 1e-9);
    ASSERT_NEAR(wrap_angle(firings[i].beam.azimuth - (std::numbers::pi - kTurn * time / 1e8)), 0.0,
                1e-9);
  }
}

TEST(ScanPattern, RingsAreRankedByElevationAndFireByDelayThenAsListed) {
  const ScanPattern pattern(four_channels());
  EXPECT_EQ(pattern.firing_order(), (std::vector<int>{0, 1, 3, 2}));
  const auto column = pattern.firings(0);
  const double elevations[] = {-10.0, -3.0, 15.0, 5.0};
  const double delays[] = {0.0, 10e3, 10e3, 20e3};
  const double ahead[] = {1.0, 3.0, -4.0, -2.0};
  for (int i = 0; i < 4; ++i) {
    EXPECT_NEAR(degrees(column[i].beam.elevation), elevations[i], 1e-9);
    EXPECT_NEAR(column[i].time_offset_ns, delays[i], 1e-6);
    const double housing = 180.0 - 360.0 * delays[i] / 1e8;
    EXPECT_NEAR(degrees(column[i].beam.azimuth), housing - ahead[i], 1e-9);
  }
}

TEST(ScanPattern, FixedIntervalsGoOnAcrossScansWithoutOverlap) {
  const ScanPattern pattern(four_channels());
  EXPECT_FALSE(pattern.repeats());
  double last = -1.0;
  std::int64_t left_out = 0;
  std::int64_t next_column = 0;
  for (std::int64_t scan = 0; scan < 50; ++scan) {
    const auto firings = pattern.firings(scan);
    ASSERT_EQ(firings.size() % 4, 0U);
    ASSERT_LE(static_cast<int>(firings.size() / 4), pattern.max_columns());
    for (std::size_t i = 0; i < firings.size(); ++i) {
      ASSERT_GE(firings[i].time_offset_ns, 0.0);
      ASSERT_LT(firings[i].time_offset_ns, 1e8) << "within its scan";
      const double time = static_cast<double>(scan) * 1e8 + firings[i].time_offset_ns;
      ASSERT_GE(time, last);
      last = time;
      if (i % 4 != 0) continue;
      const auto column = std::llround(time / 55e3);
      ASSERT_NEAR(time, 55e3 * static_cast<double>(column), 1e-3);
      left_out += column - next_column;
      next_column = column + 1;
    }
  }
  EXPECT_GT(left_out, 0);
  EXPECT_LE(left_out, 50) << "at most one column a scan does not fit";
}

TEST(ScanPattern, ARosetteIsTheSumOfItsPrisms) {
  const ScanPattern pattern(rosette());
  EXPECT_FALSE(pattern.repeats());
  EXPECT_FALSE(pattern.has_rings());
  for (const std::int64_t scan : {0, 1, 333}) {
    const auto firings = pattern.firings(scan);
    ASSERT_EQ(firings.size(), 20'000U);
    for (std::size_t i = 0; i < firings.size(); i += 37) {
      ASSERT_NEAR(firings[i].time_offset_ns, 5e3 * static_cast<double>(i), 1e-4);
      const double t = 0.1 * static_cast<double>(scan) + 5e-6 * static_cast<double>(i);
      const double offset = -3.0 + 2.0 * static_cast<double>(i % 4);
      const std::complex<double> sum = std::polar(67.5, -kTurn * 182.43 * t) +
                                       std::polar(26.5, -kTurn * 172.71 * t) +
                                       offset * std::polar(1.0, 89.0 * kRadiansPerDegree);
      ASSERT_NEAR(90.0 - degrees(firings[i].beam.elevation), std::abs(sum), 1e-6);
      ASSERT_NEAR(wrap_angle(firings[i].beam.azimuth - std::arg(sum)), 0.0, 1e-7);
    }
  }
}

TEST(ScanPattern, NoScanOfARosetteRepeatsTheOneBefore) {
  const ScanPattern pattern(rosette());
  const auto first = pattern.firings(0);
  const auto second = pattern.firings(1);
  double difference = 0.0;
  for (std::size_t i = 0; i < first.size(); ++i) {
    difference += std::abs(first[i].beam.elevation - second[i].beam.elevation);
  }
  EXPECT_GT(degrees(difference) / static_cast<double>(first.size()), 1.0);
}

TEST(ScanPattern, TablesAndRosettesThatDoNotFitTogetherAreRefused) {
  const auto error_of = [](const LidarConfig& config) {
    const auto ok = validate(config);
    return ok ? std::string() : ok.error().message;
  };
  EXPECT_EQ(error_of(four_channels()), "");
  EXPECT_EQ(error_of(rosette()), "");
  LidarConfig config = four_channels();
  config.table.firing_delays_us.pop_back();
  EXPECT_EQ(error_of(config),
            "lidar.table.firing_delays_us: expected 4 numbers, one per channel of elevations_deg, "
            "got 3");
  config = four_channels();
  config.table.firing_delays_us[1] = 60.0;
  EXPECT_EQ(error_of(config),
            "lidar.table.firing_delays_us: expected less than the 55 us of a column, got 60");
  config = rosette();
  config.rosette.prism_rates.pop_back();
  EXPECT_NE(error_of(config).find("prism_rates: expected one number per prism"), std::string::npos);
  config = rosette();
  config.rosette.point_rate = 200'010.0;
  EXPECT_NE(error_of(config).find("a whole number of firings"), std::string::npos);
  config.rosette.line_offsets_deg.clear();
  EXPECT_NE(error_of(config).find("expected 1 to 128 lines, got 0"), std::string::npos);
}

TEST(ScanPattern, FewerFiringsKeepTheField) {
  for (const LidarConfig& config : {LidarConfig(), four_channels(), rosette()}) {
    const ScanPattern pattern(config);
    const ScanPattern thinned(with_fewer_firings(config, 10));
    EXPECT_NEAR(thinned.max_columns(), pattern.max_columns() / 10.0, 1.0);
    EXPECT_EQ(thinned.lines(), pattern.lines());
  }
}

}  // namespace
}  // namespace aims
