// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "estimator/baselines/leg_kilo/observations.hpp"
#include "estimator/diagnostics.hpp"

namespace aims::leg_kilo {

/// What a scan did to the filter.
struct ScanReport {
  int points = 0;   ///< after the voxel filter
  int updates = 0;  ///< by points; 0: none lay on a plane
  int imu_samples = 0;
  int standing_feet = 0;              ///< at all these samples together
  std::vector<PointOnPlane> matches;  ///< at the states before their updates
};

/// The series that the estimator reports of each scan. The publication has no index of degeneracy;
/// eigenvalues and localizability are those of the planes of the scan.
std::vector<SeriesInfo> scan_series();

/// Their values.
ScanRow scan_row(const ScanReport& report, const Belief& belief, double variance_factor,
                 Time stamp);

}  // namespace aims::leg_kilo
