// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>

#include "core/config.hpp"
#include "core/error.hpp"
#include "sim/environment/building_config.hpp"
#include "sim/environment/scene.hpp"

namespace aims {

/// A tunnel whose centre line is an arc that leaves a = (0, 0) along +x and bends to the left. At
/// arc length s it is at (R sin(s/R), R - R cos(s/R)); the route runs from s = 0 to s = length.
struct TunnelConfig {
  double radius = 20.0;  ///< R, of the centre line [m]
  double length = 25.0;  ///< of the route, along the arc [m]
  double margin = 12.0;  ///< length of tunnel beyond either end of the route [m]
  double width = 2.2;    ///< between the walls [m]
  double height = 2.6;   ///< from floor to ceiling [m]
  DoorConfig doors;      ///< positions along the centre line's arc
};

void describe(Fields& fields, TunnelConfig& config);

/// Error for doors that do not fit or a tunnel that meets itself, naming the key.
Result<void> validate(const TunnelConfig& config);

/// The solids of a valid configuration: facets of a quarter metre are visible, slabs of two to
/// three metres collide. Streams: "scene.tunnel.doors.left" and ".right".
std::vector<Solid> tunnel_solids(const TunnelConfig& config, const ReflectivityConfig& reflectivity,
                                 std::uint64_t seed);

/// The floor under the whole tunnel; flat.
Floor tunnel_floor(const TunnelConfig& config);

}  // namespace aims
