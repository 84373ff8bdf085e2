// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <vector>

#include "sim/sensors/lidar_config.hpp"

namespace aims {

/// The constant errors of one LiDAR in one run.
struct LidarCalibration {
  double range_bias = 0.0;             ///< [m]
  double incidence_bias = 0.0;         ///< factor of 1 / cos(incidence) - 1 [m]
  double azimuth_cosine = 0.0;         ///< true minus nominal azimuth, times cos(azimuth) [rad]
  double azimuth_sine = 0.0;           ///< times sin(azimuth) [rad]
  std::vector<double> ring_range;      ///< of each ring [m]
  std::vector<double> ring_elevation;  ///< true minus nominal, of each ring [rad]

  /// Whether every beam leaves in its nominal direction.
  bool directions_are_nominal() const;
};

/// Draws the errors of a run from "lidar.calibration". The draws do not depend on the deviations:
/// twice the deviation is twice the error.
LidarCalibration draw_calibration(const LidarConfig& config, std::uint64_t run_seed);

}  // namespace aims
