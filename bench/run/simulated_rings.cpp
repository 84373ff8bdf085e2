// SPDX-License-Identifier: BSD-3-Clause
#include "bench/run/simulated_rings.hpp"

#include "core/angle.hpp"
#include "estimator/estimator_spec.hpp"
#include "sim/sensors/scan_pattern.hpp"

namespace aims {

LidarRings rings_of(const LidarConfig& config) {
  const ScanPattern pattern(config);
  if (!pattern.has_rings()) return {};
  const int count = pattern.lines();
  if (count == 1) return {1, 0.0};
  const double span =
      pattern.firing(0, 0, count - 1).beam.elevation - pattern.firing(0, 0, 0).beam.elevation;
  return {count, span / (count - 1) / kRadiansPerDegree};
}

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

}  // namespace aims
