// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "estimator/aims/config.hpp"

namespace aims {

/// Replaces a sample rate that is still the default by the measured one where they differ by more
/// than 10 %. Returns one note per replaced rate.
std::vector<std::string> adopt_sample_rates(std::optional<double> imu_hz,
                                            std::optional<double> leg_hz, EstimatorConfig& config);

}  // namespace aims
