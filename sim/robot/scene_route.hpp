// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "sim/environment/scene_config.hpp"
#include "sim/robot/route.hpp"

namespace aims {

/// The route along the centre line of a valid scene to its far end and the same way back. Named
/// points: a and b of a corridor or a tunnel, a, d and h of a garage, a, j and b (of the right
/// branch) of a junction. Points on bends have no name, so that the robot does not stop there. Of a
/// loop the way around by b, as often as it has laps, back to a.
std::vector<RoutePoint> points_along(const SceneConfig& scene);

/// The route with its points along the scene when it is to follow it; else as it is.
RouteConfig route_in(const SceneConfig& scene, const RouteConfig& route);

}  // namespace aims
