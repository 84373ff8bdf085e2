// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <vector>

#include "core/config.hpp"
#include "core/error.hpp"
#include "sim/environment/building_config.hpp"
#include "sim/environment/garage.hpp"
#include "sim/environment/junction.hpp"
#include "sim/environment/loop.hpp"
#include "sim/environment/people.hpp"
#include "sim/environment/ramp.hpp"
#include "sim/environment/scene.hpp"
#include "sim/environment/tunnel.hpp"
#include "sim/environment/wall.hpp"

namespace aims {

/// The ends of the corridor that are closed by a wall; the others are open.
enum class EndWalls { kNone, kStart, kEnd, kBoth };

/// Square half-columns standing out from the walls.
struct PillarConfig {
  WallSides sides = WallSides::kBoth;
  double spacing = 0.0;  ///< between centres along one wall [m]; 0: no pillars
  double size = 0.4;     ///< along the wall [m]
  double depth = 0.15;   ///< out of the wall [m]
};

/// Boxes and cylinders along the walls: visible, but without collisions.
struct ClutterConfig {
  double density = 0.0;     ///< objects per metre of corridor [1/m]
  double free_width = 1.3;  ///< of the middle of the corridor, without clutter [m]
};

/// Equal lamps in a row under the ceiling, along the middle: visible, but without collisions.
struct LampConfig {
  double spacing = 0.0;  ///< between centres [m]; 0: none
  double length = 1.2;   ///< along the corridor [m]
  double width = 0.15;   ///< [m]
  double height = 0.08;  ///< below the ceiling [m]
};

/// Smooth random unevenness of the floor.
struct BumpConfig {
  double height = 0.0;              ///< between the lowest and the highest point [m]; 0: flat
  double correlation_length = 0.6;  ///< of the heights [m]
};

/// A bend of a corridor.
struct BendConfig {
  double at = 0.5;          ///< on the centre line, as a fraction of the route's length [-]
  double angle_deg = 0.0;   ///< between the directions before and after [deg]; 0: no bend
  Side side = Side::kLeft;  ///< to which the corridor turns
};

/// A corridor that begins along +x with its centre line on y = 0, its floor at z = 0; straight
/// unless it has bends. The route runs on the centre line from (0, 0) over `length`.
struct CorridorConfig {
  double length = 78.6;  ///< of the route [m]
  double margin = 3.0;   ///< length of corridor beyond either end of the route [m]
  double width = 2.2;    ///< between the walls [m]
  double height = 2.6;   ///< from floor to ceiling [m]
  EndWalls end_walls = EndWalls::kBoth;
  std::vector<BendConfig> bends;  ///< in order; with any, no pillars, lamps, glass or ramp
  DoorConfig doors;
  PillarConfig pillars;
  ClutterConfig clutter;
  LampConfig lamps;
  GlassConfig glass;
};

enum class SceneKind { kCorridor, kGarage, kJunction, kTunnel, kLoop };

/// The environment of the robot.
struct SceneConfig {
  SceneKind kind = SceneKind::kCorridor;
  int seed = 0;                 ///< of door jitter, clutter and bumps; 0: the seed of the run
  double floor_friction = 0.8;  ///< sliding friction under the feet [-], for the physics
  BumpConfig bumps;
  ReflectivityConfig reflectivity;
  SurfaceConfig surface;
  CorridorConfig corridor;
  RampConfig ramp;  ///< corridor only
  PeopleConfig people;
  GarageConfig garage;
  JunctionConfig junction;
  TunnelConfig tunnel;
  LoopConfig loop;
};

void describe(Fields& fields, PillarConfig& config);
void describe(Fields& fields, ClutterConfig& config);
void describe(Fields& fields, LampConfig& config);
void describe(Fields& fields, BumpConfig& config);
void describe(Fields& fields, BendConfig& config);
void describe(Fields& fields, CorridorConfig& config);
void describe(Fields& fields, SceneConfig& config);

/// Error for a combination that cannot be built, for example doors wider than their spacing.
Result<void> validate(const SceneConfig& config);

/// The scene of a valid configuration. Same configuration and seed: the same scene.
Scene build_scene(const SceneConfig& config, std::uint64_t run_seed);

}  // namespace aims
