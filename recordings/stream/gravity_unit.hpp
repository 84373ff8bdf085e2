// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace aims {

inline constexpr double kStandardGravity = 9.80665;  ///< one g [m/s^2]

/// Whether a typical specific force of that norm is in g: a robot measures about 1 g.
constexpr bool is_in_gravities(double typical_force) {
  return typical_force > 0.5 && typical_force < 2.0;
}

}  // namespace aims
