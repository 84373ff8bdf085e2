// SPDX-License-Identifier: BSD-3-Clause
#include "bench/run/calibration_fit.hpp"

#include "estimator/estimator_spec.hpp"
#include "sim/simulation.hpp"

namespace aims {

std::vector<std::string> misfits(const RobotCalibration& calibration, const Scenario& scenario) {
  return misfits(calibration.sensors, sensors_of(nominal_rig(scenario.simulation), {}));
}

bool is_of_another_robot(const std::string& estimator, const Scenario& scenario) {
  const auto spec = parse_estimator_spec(estimator);
  if (!spec) return false;
  const auto config = config_with(*spec, scenario.estimators);
  if (!config) return false;
  const Fields fields = fields_of(**config);
  const Parameter* enabled = fields.find("prior.enabled");
  if (enabled == nullptr || enabled->text() != "true") return false;
  const auto calibration = read_robot_calibration(fields.find("prior.file")->text());
  return calibration && !misfits(*calibration, scenario).empty();
}

}  // namespace aims
