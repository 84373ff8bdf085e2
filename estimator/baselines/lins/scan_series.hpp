// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <vector>

#include "estimator/baselines/lins/robocentric_odometry.hpp"
#include "estimator/diagnostics.hpp"

namespace aims::lins {

/// What LINS reports of a scan.
struct ScanReport {
  int points_in = 0;  ///< returns in range
  int ground = 0;     ///< returns of the ground
  int segmented = 0;  ///< returns of kept segments
  OdometryResult odometry;
  std::optional<features::SolverResult> mapping;  ///< none: the scan was not registered to the map
  int loops = 0;                                  ///< loops closed so far
};

/// The series of its diagnostics.
std::vector<SeriesInfo> scan_series();

/// Its row, in the order of `scan_series`.
ScanRow row_of(const ScanReport& scan, Time stamp);

}  // namespace aims::lins
