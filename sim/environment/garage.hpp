// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>

#include "core/config.hpp"
#include "core/error.hpp"
#include "sim/environment/building_config.hpp"
#include "sim/environment/scene.hpp"

namespace aims {

/// A garage hall between two corridors with a dead end each (the paper's second experiment). The
/// first corridor runs along +x from a = (0, 0) into the hall, whose point d = (approach, 0) is the
/// corner of the route; the second leaves the hall along -y, to h = (approach, -exit).
struct GarageConfig {
  double approach = 45.0;         ///< from a to d [m]
  double exit = 45.0;             ///< from d to h [m]
  double margin = 3.0;            ///< of corridor behind a and behind h [m]
  double width = 2.2;             ///< of the corridors [m]
  double height = 2.6;            ///< of the corridors [m]
  double opening_distance = 8.0;  ///< from d to the opening of either corridor [m]
  double hall_extent = 12.0;      ///< of the hall beyond d, along +x and along +y [m]
  double hall_height = 3.2;       ///< [m]
  int cars = 5;                   ///< parked along the hall's far wall
  DoorConfig doors = {.spacing = 12.0, .depth = 0.05};  ///< of the corridors
};

void describe(Fields& fields, GarageConfig& config);

/// Error for doors or lengths that cannot be built, naming the key.
Result<void> validate(const GarageConfig& config);

/// The solids of a valid configuration. Streams: "scene.garage.doors.first.left" and so on,
/// "scene.garage.cars".
std::vector<Solid> garage_solids(const GarageConfig& config, const ReflectivityConfig& reflectivity,
                                 std::uint64_t seed);

/// The floor under both corridors and the hall; flat.
Floor garage_floor(const GarageConfig& config);

}  // namespace aims
