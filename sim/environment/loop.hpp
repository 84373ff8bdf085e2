// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <vector>

#include "core/config.hpp"
#include "core/error.hpp"
#include "sim/environment/building_config.hpp"
#include "sim/environment/scene.hpp"

namespace aims {

struct CorridorPiece;

/// A corridor around a block: its centre line is a rectangle that begins at a = (0, 0), the middle
/// of a side along +x, and turns to the left at each corner; b is the middle of the opposite side.
struct LoopConfig {
  double length = 24.0;  ///< of the sides along x, on the centre line [m]
  double depth = 14.0;   ///< of the sides along y, on the centre line [m]
  int laps = 1;          ///< of a route that follows the scene
  double width = 2.2;    ///< between the walls [m]
  double height = 2.6;   ///< from floor to ceiling [m]
  DoorConfig doors;
};

void describe(Fields& fields, LoopConfig& config);

/// Error for doors that do not fit, or a block without room for its walls, naming the key.
Result<void> validate(const LoopConfig& config);

/// The four sides in the order in which the route walks them; the first holds a in its middle.
std::vector<CorridorPiece> loop_pieces(const LoopConfig& config);

/// The solids of a valid configuration. Streams: "scene.doors.left.0" and so on by side.
std::vector<Solid> loop_solids(const LoopConfig& config, const ReflectivityConfig& reflectivity,
                               std::uint64_t seed);

/// The floor under all sides; flat.
Floor loop_floor(const LoopConfig& config);

}  // namespace aims
