// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "core/error.hpp"
#include "sim/environment/scene.hpp"
#include "sim/robot/route.hpp"

namespace aims {

/// The room that a walking robot takes.
struct BodySize {
  double height = 0.29;      ///< of the trunk above the floor [m]
  double half_width = 0.16;  ///< with its feet, as far as a wall must be [m]
};

/// Error when the robot cannot walk the route in that scene: a point is outside the building or
/// inside a solid, or a solid that collides is in the way between two points. People are no
/// obstacles.
Result<void> check_walkable(const RouteConfig& route, const Scene& scene, const BodySize& body);

}  // namespace aims
