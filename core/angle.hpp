// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <numbers>

namespace aims {

/// Factor from degrees to radians [rad/deg].
inline constexpr double kRadiansPerDegree = std::numbers::pi / 180.0;

}  // namespace aims
