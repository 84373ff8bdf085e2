// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "bench/scenario/scenario.hpp"
#include "estimator/robot_calibration.hpp"

namespace aims {

/// A sentence for each estimator of the scenario that its LiDAR does not fit.
std::vector<std::string> ring_notes(const Scenario& scenario);

/// How the robot of the scenario differs from that of the calibration, one clause each.
std::vector<std::string> misfits(const RobotCalibration& calibration, const Scenario& scenario);

/// Whether the estimator of that spec starts from a calibration whose file says that it is of
/// another robot than that of the scenario.
bool is_of_another_robot(const std::string& estimator, const Scenario& scenario);

}  // namespace aims
