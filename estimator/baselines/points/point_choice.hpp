// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "core/measurements.hpp"

namespace aims::points {

/// One return of every `every_nth`, in order of firing, that is further than `min_range` [m], as
/// indices into `scan`.
std::vector<int> chosen_points(const LidarScan& scan, int every_nth, double min_range);

}  // namespace aims::points
