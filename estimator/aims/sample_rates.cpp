// SPDX-License-Identifier: BSD-3-Clause
#include "estimator/aims/sample_rates.hpp"

#include <fmt/format.h>

#include <cmath>

namespace aims {
namespace {

/// Relative difference up to which the configured rate stays [-].
constexpr double kTolerance = 0.1;

void adopt(std::optional<double> measured_hz, const char* key, double default_hz,
           double& configured_hz, std::vector<std::string>& notes) {
  if (!measured_hz || configured_hz != default_hz) return;
  if (std::abs(*measured_hz - configured_hz) <= kTolerance * configured_hz) return;
  configured_hz = *measured_hz;
  notes.push_back(
      fmt::format("estimator.{} = {:.4g}, the rate found in the recording", key, configured_hz));
}

}  // namespace

std::vector<std::string> adopt_sample_rates(std::optional<double> imu_hz,
                                            std::optional<double> leg_hz, EstimatorConfig& config) {
  const EstimatorConfig defaults;
  std::vector<std::string> notes;
  adopt(imu_hz, "imu.rate_hz", defaults.imu.rate_hz, config.imu.rate_hz, notes);
  adopt(leg_hz, "leg.rate_hz", defaults.leg.rate_hz, config.leg.rate_hz, notes);
  return notes;
}

}  // namespace aims
