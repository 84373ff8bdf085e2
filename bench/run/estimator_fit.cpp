// SPDX-License-Identifier: BSD-3-Clause
#include "bench/run/estimator_fit.hpp"

#include "bench/estimate/ring_note.hpp"
#include "core/angle.hpp"
#include "estimator/estimator_spec.hpp"
#include "sim/sensors/scan_pattern.hpp"
#include "sim/simulation.hpp"

namespace aims {
namespace {

/// The rings of a simulated LiDAR.
LidarRings rings_of(const LidarConfig& config) {
  const ScanPattern pattern(config);
  if (!pattern.has_rings()) return {};
  const int count = pattern.lines();
  if (count == 1) return {1, 0.0};
  const double span =
      pattern.firing(0, 0, count - 1).beam.elevation - pattern.firing(0, 0, 0).beam.elevation;
  return {count, span / (count - 1) / kRadiansPerDegree};
}

}  // namespace

std::vector<std::string> ring_notes(const Scenario& scenario) {
  std::vector<std::string> notes;
  const LidarRings rings = rings_of(scenario.simulation.lidar);
  for (const std::string& spec : scenario.run) {
    std::string note =
        ring_note(label_of(spec), requirements_of(spec, scenario.estimators), rings, "LiDAR");
    if (!note.empty()) notes.push_back(std::move(note));
  }
  return notes;
}

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
