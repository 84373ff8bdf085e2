// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "bench/scenario/scenario.hpp"
#include "estimator/robot_calibration.hpp"

namespace aims {

/// How the robot of the scenario differs from that of the calibration, one clause each.
std::vector<std::string> misfits(const RobotCalibration& calibration, const Scenario& scenario);

}  // namespace aims
