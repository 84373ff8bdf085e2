// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <vector>

#include "sim/environment/scene.hpp"

namespace aims {

/// The edges of the visible solids but for roofs, as lines through points of the world [m]: twelve
/// of a box, in four lines; the two circles of a cylinder.
std::vector<std::vector<Eigen::Vector3f>> scene_edges(const Scene& scene);

}  // namespace aims
