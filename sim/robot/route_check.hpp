// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "core/error.hpp"
#include "sim/environment/scene.hpp"
#include "sim/robot/route.hpp"

namespace aims {

/// Error when the robot cannot walk the route in that scene: a point is outside the building or
/// inside a solid, or a solid that collides is in the way between two points. People are no
/// obstacles. `body_height`: of the trunk above the floor [m].
Result<void> check_walkable(const RouteConfig& route, const Scene& scene, double body_height);

}  // namespace aims
