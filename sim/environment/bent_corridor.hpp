// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <vector>

#include "sim/environment/corridor_pieces.hpp"
#include "sim/environment/scene_config.hpp"
#include "sim/environment/wall.hpp"

namespace aims {

/// Walls, ceiling, end walls, doors and clutter of a valid corridor with bends. Streams:
/// "scene.doors.left.0" and so on by piece, "scene.clutter".
std::vector<Solid> bent_corridor_solids(const CorridorConfig& config, const Materials& materials,
                                        std::uint64_t seed);

/// Adds walls with doors and ceilings of the pieces. Streams as above.
void add_pieces(const std::vector<CorridorPiece>& pieces, const CorridorConfig& config,
                const Materials& materials, std::uint64_t seed, std::vector<Solid>& solids);

/// The part of a piece that people walk, who turn half a metre before its bends and 1 m before the
/// corridor's ends.
Span walked_part(const CorridorPiece& piece, double width);

/// The rectangle of floor under all pieces.
Floor floor_under(const std::vector<CorridorPiece>& pieces, const CorridorConfig& config);

}  // namespace aims
