// SPDX-License-Identifier: BSD-3-Clause
#include "estimator/aims/sample_rates.hpp"

#include <gtest/gtest.h>

namespace aims {
namespace {

TEST(SampleRates, AMeasuredRateReplacesTheDefault) {
  EstimatorConfig config;
  const double leg_hz = config.leg.rate_hz;
  const auto notes = adopt_sample_rates(4.0 * config.imu.rate_hz, 1.05 * leg_hz, config);
  EXPECT_EQ(config.imu.rate_hz, 4.0 * EstimatorConfig().imu.rate_hz);
  EXPECT_EQ(config.leg.rate_hz, leg_hz) << "within 10 %";
  ASSERT_EQ(notes.size(), 1U);
  EXPECT_NE(notes[0].find("estimator.imu.rate_hz = "), std::string::npos) << notes[0];
}

TEST(SampleRates, AConfiguredRateStays) {
  EstimatorConfig config;
  config.imu.rate_hz = 123.0;
  EXPECT_TRUE(adopt_sample_rates(1000.0, std::nullopt, config).empty());
  EXPECT_EQ(config.imu.rate_hz, 123.0);
}

}  // namespace
}  // namespace aims
