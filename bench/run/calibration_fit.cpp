// SPDX-License-Identifier: BSD-3-Clause
#include "bench/run/calibration_fit.hpp"

#include "sim/simulation.hpp"

namespace aims {

std::vector<std::string> misfits(const RobotCalibration& calibration, const Scenario& scenario) {
  return misfits(calibration.sensors, sensors_of(nominal_rig(scenario.simulation), {}));
}

}  // namespace aims
