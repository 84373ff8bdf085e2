// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <vector>

#include "estimator/baselines/features/feature_solver.hpp"
#include "estimator/diagnostics.hpp"

namespace aims::loam {

/// What LOAM reports of a scan.
struct ScanReport {
  int points_in = 0;                              ///< finite returns in range
  int edges = 0;                                  ///< sharp features
  int planes = 0;                                 ///< flat features
  features::SolverResult odometry;                ///< scan to scan
  std::optional<features::SolverResult> mapping;  ///< none: the scan was not registered to the map
};

/// The series of its diagnostics.
std::vector<SeriesInfo> scan_series();

/// Its row, in the order of `scan_series`.
ScanRow row_of(const ScanReport& scan, Time stamp);

}  // namespace aims::loam
