// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "core/config.hpp"
#include "sim/environment/scene.hpp"

namespace aims {

/// A slope of the floor along +x; beyond it the floor stays at the new height.
struct RampConfig {
  double start = 8.0;   ///< where the floor begins to rise [m]
  double length = 8.0;  ///< of the slope, along x [m]
  double grade = 0.0;   ///< rise over length [-]; 0: no ramp
};

void describe(Fields& fields, RampConfig& config);

/// Height of the floor at x [m].
double ramp_height(const RampConfig& ramp, double x);

/// Total rise [m].
double ramp_rise(const RampConfig& ramp);

/// Widens a flat floor so that begin and end of the slope lie on lines of its grid, and fills in
/// the heights. Does nothing without a ramp.
void add_ramp(const RampConfig& ramp, Floor& floor);

}  // namespace aims
