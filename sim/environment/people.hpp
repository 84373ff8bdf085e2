// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/config.hpp"
#include "core/error.hpp"
#include "sim/environment/ray_caster.hpp"
#include "sim/environment/scene.hpp"
#include "sim/environment/wall.hpp"

namespace aims {

/// People who walk up and down the corridors of a scene, each in a lane beside the robot's.
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

/// A level stretch of floor that people walk up and down.
struct Stretch {
  Pose T_world_stretch;  ///< the x axis is the centre line, or its tangent at the begin of an arc
  Span along;            ///< of the centre line; of an arc from 0 [m]
  double turn = 0.0;     ///< of the centre line over an arc, positive to the left [rad]; 0: a line
  double ground = 0.0;   ///< height of the floor [m]
};

/// People on the stretches in turn, of which there is one at least; side, position and direction of
/// each are drawn from "scene.people". People do not collide with each other.
std::vector<Person> people_on(std::span<const Stretch> stretches, const PeopleConfig& config,
                              std::uint64_t seed);

/// Occludes hits by people: where a ray hits a person first, the person becomes the hit, with the
/// surface `first_surface` + the person's index. The ray-cylinder intersection is exact, each lane
/// at its own time `stamps[lane]`. Rays start outside of people.
void intersect_people(const std::vector<Person>& people, const RayPacket& rays,
                      const std::array<Time, kRayPacketSize>& stamps, int first_surface,
                      float max_distance, HitPacket& hits);

}  // namespace aims
