// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <limits>

#include "core/lie.hpp"
#include "core/scan_information.hpp"
#include "sim/sensors/lidar.hpp"

namespace aims {

/// Least range noise that information is computed for [m]: without noise it would be infinite.
inline constexpr double kLeastRangeSigma = 1e-4;

/// Fisher information of the scan's returns about the body's pose `T_world_body` at `stamp`, the
/// scan's end, against the true scene. A range d along a known beam u to a known plane with normal
/// n changes by -h . (rotation, translation) / (n . u) with h = [p x n; n] in body axes, p the true
/// hit; its noise is `range_sigma`, so that a return adds h h^T / (range_sigma cos(incidence))^2:
/// the point-to-plane noise of a range error shrinks with the cosine. The motion within the scan
/// is taken as known. Left out are what edges tell, what misses tell, and returns of surfaces from
/// `first_moving_surface` on, which are no part of a map.
ScanInformation scan_information(Time stamp, const ScanTruth& scan, const Pose& T_world_body,
                                 double range_sigma,
                                 int first_moving_surface = std::numeric_limits<int>::max());

}  // namespace aims
