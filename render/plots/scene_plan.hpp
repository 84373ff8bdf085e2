// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "sim/environment/scene.hpp"

namespace aims {

/// Outlines, seen from above in the world's xy plane [m], of the visible solids that stand in the
/// way: roofs, what ends below `min_top` and what begins above `max_bottom` [m], as a lintel does,
/// are left out. Each is convex, counter-clockwise.
std::vector<std::vector<Eigen::Vector2d>> scene_plan(const Scene& scene, double min_top = 0.05,
                                                     double max_bottom = 1.2);

/// For each point whether it is at most `section` [m] over the lowest point of its 2 m cell of the
/// ground: what is left when the roof is cut off, also over a ramp.
std::vector<bool> under_roof(std::span<const Eigen::Vector3f> points, double section);

}  // namespace aims
