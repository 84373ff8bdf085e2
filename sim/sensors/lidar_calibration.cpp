// SPDX-License-Identifier: BSD-3-Clause
#include "sim/sensors/lidar_calibration.hpp"

#include <algorithm>

#include "core/angle.hpp"
#include "core/random.hpp"

namespace aims {

bool LidarCalibration::directions_are_nominal() const {
  return azimuth_cosine == 0.0 && azimuth_sine == 0.0 &&
         std::ranges::all_of(ring_elevation, [](double offset) { return offset == 0.0; });
}

LidarCalibration draw_calibration(const LidarConfig& config, std::uint64_t run_seed) {
  const LidarCalibrationConfig& spread = config.calibration;
  RandomStream random = rng(run_seed, "lidar.calibration");
  LidarCalibration drawn;
  drawn.range_bias = spread.range_bias_sigma * random.normal();
  drawn.incidence_bias = spread.incidence_bias_mean + spread.incidence_bias_sigma * random.normal();
  if (config.pattern == LidarPattern::kRosette) {  // neither encoder nor rings
    drawn.ring_range.resize(static_cast<std::size_t>(line_count(config)));
    drawn.ring_elevation.resize(drawn.ring_range.size());
    return drawn;
  }
  drawn.azimuth_cosine = kRadiansPerDegree * spread.azimuth_sigma_deg * random.normal();
  drawn.azimuth_sine = kRadiansPerDegree * spread.azimuth_sigma_deg * random.normal();
  for (int ring = 0; ring < line_count(config); ++ring) {
    drawn.ring_range.push_back(spread.ring_range_sigma * random.normal());
    drawn.ring_elevation.push_back(kRadiansPerDegree * spread.ring_elevation_sigma_deg *
                                   random.normal());
  }
  return drawn;
}

}  // namespace aims
