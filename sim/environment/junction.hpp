// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>

#include "core/config.hpp"
#include "core/error.hpp"
#include "sim/environment/building_config.hpp"
#include "sim/environment/scene.hpp"

namespace aims {

/// A corridor along +x from a = (0, 0) that ends in a crossing corridor along y, whose centre line
/// is at x = length. All ends are dead.
struct JunctionConfig {
  double length = 13.0;  ///< from a to the crossing's centre line [m]
  double branch = 12.0;  ///< of either branch, up to its last route point [m]
  double margin = 12.0;  ///< length of corridor beyond the end points of the route [m]
  double width = 2.2;    ///< between the walls [m]
  double height = 2.6;   ///< from floor to ceiling [m]
  DoorConfig doors;
};

void describe(Fields& fields, JunctionConfig& config);

/// Error for doors that do not fit, naming the key.
Result<void> validate(const JunctionConfig& config);

/// The solids of a valid configuration. Streams: "scene.junction.doors.stem.left" and so on.
std::vector<Solid> junction_solids(const JunctionConfig& config,
                                   const ReflectivityConfig& reflectivity, std::uint64_t seed);

/// The floor under all corridors; flat.
Floor junction_floor(const JunctionConfig& config);

}  // namespace aims
