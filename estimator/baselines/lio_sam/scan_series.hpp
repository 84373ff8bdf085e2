// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <vector>

#include "estimator/baselines/lio_sam/mapping.hpp"
#include "estimator/diagnostics.hpp"

namespace aims::lio_sam {

/// What LIO-SAM reports of a scan.
struct ScanReport {
  int points_in = 0;     ///< returns in range
  bool guessed = false;  ///< the IMU odometry gave the guess
  std::optional<RegisteredScan> registered;
  int resets = 0;                   ///< failures of the IMU odometry so far
  int loops = 0;                    ///< loops closed so far
  double speed = 0.0;               ///< of the newest key [m/s]
  double accelerometer_bias = 0.0;  ///< likewise [m/s^2]
  double gyro_bias = 0.0;           ///< likewise [rad/s]
};

/// The series of its diagnostics.
std::vector<SeriesInfo> scan_series();

/// Its row, in the order of `scan_series`.
ScanRow row_of(const ScanReport& scan, Time stamp);

}  // namespace aims::lio_sam
