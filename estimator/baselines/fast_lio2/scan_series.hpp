// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "estimator/baselines/fast_lio2/iterated_update.hpp"
#include "estimator/diagnostics.hpp"

namespace aims::fast_lio2 {

/// The series that the estimator reports of each scan. The publication has no index of degeneracy;
/// eigenvalues and localizability are those of the residuals of the last iteration.
std::vector<SeriesInfo> scan_series();

/// Their values. `points`: after the voxel filter; `variance`: of a residual [m^2].
ScanRow scan_row(const Update& update, std::size_t points, double variance, Time stamp);

}  // namespace aims::fast_lio2
