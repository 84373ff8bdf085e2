// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "core/error.hpp"
#include "sim/environment/scene.hpp"
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

/// What makes a scene longer: "scene.corridor.length", "scene.garage.approach".
const char* length_key(SceneKind kind);

/// "scene.corridor.length and route.points go together: ...": what to change where a scene and the
/// points of its route do not fit.
std::string route_hint(SceneKind kind);

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
