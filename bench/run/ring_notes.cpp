// SPDX-License-Identifier: BSD-3-Clause
#include "bench/run/ring_notes.hpp"

#include <fmt/format.h>

#include <cmath>

#include "core/angle.hpp"
#include "estimator/estimator_spec.hpp"
#include "sim/sensors/scan_pattern.hpp"

namespace aims {
namespace {

/// Relative difference of the angles between rings and rows that is no mismatch.
constexpr double kSpacingTolerance = 0.25;

bool fits(const LidarRings& image, const LidarRings& rings) {
  return image.count == rings.count &&
         std::abs(image.spacing_deg - rings.spacing_deg) <= kSpacingTolerance * rings.spacing_deg;
}

}  // namespace

std::string ring_note(std::string_view label, const Requirements& needs, const LidarRings& rings,
                      std::string_view source) {
  if (!needs.rings) return {};
  if (rings.count == 0) {
    return fmt::format("{} needs the ring of each point, which the {} lacks", label, source);
  }
  const LidarRings& image = needs.range_image;
  if (image.count == 0 || fits(image, rings)) return {};
  return fmt::format(
      "{} has a range image of {} rows {:.3g} deg apart, but the {} has {} rings {:.3g} deg apart: "
      "set its image.rows and image.row_angle_deg",
      label, image.count, image.spacing_deg, source, rings.count, rings.spacing_deg);
}

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
