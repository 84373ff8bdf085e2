// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <limits>

#include "core/lie.hpp"
#include "core/scan_information.hpp"
#include "sim/sensors/lidar.hpp"

namespace aims {

/// Smallest range noise for which information is computed [m]: without noise it is infinite.
inline constexpr double kMinRangeSigma = 1e-4;

/// Fisher information of the scan's returns about the body's pose `T_world_body` at `stamp`, the
/// scan's end, against the true scene. A range d along a known beam u to a known plane with normal
/// n changes by -h . (rotation, translation) / (n . u) with h = [p x n; n] in body axes, p the true
/// hit; its noise is sigma, so that a return adds h h^T / (sigma cos(incidence))^2:
/// the point-to-plane noise of a range error shrinks with the cosine. The motion within the scan
/// is taken as known. sigma is the return's own noise where the scan has it, else `range_sigma`;
/// the result's is the uniform noise with the same mean of 1 / sigma^2. Constant errors of the
/// sensor are taken as known. Not included: information from edges (footprints over an edge, whose
/// noise is infinite), from missing returns, and from returns of surfaces from
/// `first_moving_surface` on, which are no part of a map.
ScanInformation scan_information(Time stamp, const ScanTruth& scan, const Pose& T_world_body,
                                 double range_sigma,
                                 int first_moving_surface = std::numeric_limits<int>::max());

}  // namespace aims
