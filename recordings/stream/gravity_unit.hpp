// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace aims {

inline constexpr double kStandardGravity = 9.80665;  ///< one g [m/s^2]

/// Whether specific forces of that usual size are told in g: a robot feels about one.
constexpr bool is_in_gravities(double usual_force) {
  return usual_force > 0.5 && usual_force < 2.0;
}

}  // namespace aims
