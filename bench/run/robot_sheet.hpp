// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <string_view>

#include "core/config.hpp"
#include "core/error.hpp"
#include "sim/sensors/sensor_level.hpp"
#include "sim/simulation_config.hpp"

namespace aims {

/// What a robot.yaml in models states of the robot, apart from the keys of a scenario.
struct RobotSheet {
  std::string description;  ///< one line
  double mass = 0.0;        ///< [kg]
};

void describe(Fields& fields, RobotSheet& sheet);

/// Sets the keys of `config` that the robot's file gives at that level, and returns its sheet.
/// Error for a robot that there is not, or for a file that cannot be read.
Result<RobotSheet> apply_robot_model(std::string_view model, SensorLevel level,
                                     SimulationConfig& config);

/// One line on a robot, for listings.
std::string robot_summary(const RobotSheet& sheet, const SimulationConfig& config);

}  // namespace aims
