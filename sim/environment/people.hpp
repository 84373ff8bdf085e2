// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <vector>

#include "core/config.hpp"
#include "core/error.hpp"
#include "sim/environment/ray_caster.hpp"
#include "sim/environment/scene.hpp"

namespace aims {

/// People who walk up and down a corridor, each in a lane beside the robot's.
struct PeopleConfig {
  int count = 0;              ///< 0: none
  double speed = 1.2;         ///< [m/s]
  double radius = 0.25;       ///< [m]
  double height = 1.75;       ///< [m]
  double lane_offset = 0.75;  ///< of a person's path from the centre line [m]
  double reflectivity = 0.4;  ///< of clothes [-]
};

void describe(Fields& fields, PeopleConfig& config);

/// Error for lanes that run into the walls or over the robot.
Result<void> validate(const PeopleConfig& config, double corridor_width);

/// People between two positions along x [m]; side, position and direction of each are drawn from
/// "scene.people". People do not collide with each other.
std::vector<Person> people_in_lanes(const PeopleConfig& config, double begin, double end,
                                    std::uint64_t seed);

/// Occludes hits by people: where a ray hits a person first, the person becomes the hit, with the
/// surface `first_surface` + the person's index. The ray-cylinder intersection is exact, each lane
/// at its own time `stamps[lane]`. Rays start outside of people.
void intersect_people(const std::vector<Person>& people, const RayPacket& rays,
                      const std::array<Time, kRayPacketSize>& stamps, int first_surface,
                      float max_distance, HitPacket& hits);

}  // namespace aims
