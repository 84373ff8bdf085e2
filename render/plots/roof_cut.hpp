// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

namespace aims {

/// For each point whether it is at most `section` [m] over the lowest point of its 2 m cell of the
/// ground: what is left when the roof is cut off, also over a ramp.
std::vector<bool> under_roof(std::span<const Eigen::Vector3f> points, double section);

}  // namespace aims
