// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <vector>

#include "sim/environment/scene_config.hpp"
#include "sim/environment/wall.hpp"

namespace aims {

/// Walls, ceiling, end walls, doors and clutter of a valid corridor with bends. Streams:
/// "scene.doors.left.0" and so on by piece, "scene.clutter".
std::vector<Solid> bent_corridor_solids(const CorridorConfig& config, const Materials& materials,
                                        std::uint64_t seed);

/// People in lanes of the longest piece, who turn half a metre before its bends and 1 m before the
/// corridor's ends.
std::vector<Person> people_on_longest_piece(const CorridorConfig& config,
                                            const PeopleConfig& people, std::uint64_t seed);

/// The rectangle of floor under all pieces.
Floor bent_corridor_floor(const CorridorConfig& config);

}  // namespace aims
