// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>

#include "sim/sensors/sensor_level.hpp"
#include "sim/simulation_config.hpp"
#include "tests/support/walking.hpp"

namespace aims::testing {

/// Error of leg odometry over 10 m there, a turn on the spot, and 10 m back.
struct LegDrift {
  double out = 0.0;     ///< reported over true length of the way there, less one
  double back = 0.0;    ///< the same of the way back
  double turn = 0.0;    ///< error of the displacement reported during the turn [m]
  double height = 0.0;  ///< error of the height at the end over the length of the walk

  double mean() const { return 0.5 * (out + back); }
};

/// The simulation at that level of the sensors.
SimulationConfig config_at(SensorLevel level);

/// The odometry without any error but those of its foot model, its contact thresholds and the
/// ground.
LegOdometryConfig without_errors(const LegOdometryConfig& config);

/// The robot of that configuration and seed walks there and back on a flat floor.
Walk drift_walk(const SimulationConfig& config, double friction, std::uint64_t seed);

/// The same robot walks a square of 3.2 x 3.4 m, without a pause at its corners.
Walk square_walk(const SimulationConfig& config, double friction, std::uint64_t seed);

/// Reported over true length of the path of any walk, less one; the path goes from stride to
/// stride.
double path_error(const Walk& walk, const SimulationConfig& config, std::uint64_t seed);

/// What that odometry makes of a walk there and back.
LegDrift drift_of(const Walk& walk, const LegOdometryConfig& config, std::uint64_t seed);

}  // namespace aims::testing
