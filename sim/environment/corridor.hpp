// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "core/random.hpp"
#include "sim/environment/scene_config.hpp"

namespace aims {

/// Error for a corridor that cannot be built.
Result<void> validate(const CorridorConfig& config);

/// Whether a wall closes that end.
bool has_end(const CorridorConfig& config, EndWalls end);

/// One box or cylinder at `x` that touches a wall of a corridor along the x axis, clear of the
/// walkway.
Solid clutter_object(const CorridorConfig& config, double x, const Material& material,
                     RandomStream& random);

/// Walls, ceiling, doors, pillars and clutter of a valid corridor.
std::vector<Solid> corridor_solids(const CorridorConfig& config, const RampConfig& ramp,
                                   const ReflectivityConfig& reflectivity, std::uint64_t seed);

/// The rectangle of floor that the corridor stands on.
Floor corridor_floor(const CorridorConfig& config);

}  // namespace aims
