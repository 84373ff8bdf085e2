// SPDX-License-Identifier: BSD-3-Clause
#include "sim/environment/scene_config.hpp"

#include <fmt/format.h>

#include "sim/environment/corridor.hpp"
#include "sim/environment/height_field.hpp"

namespace aims {
void describe(Fields& f, PillarConfig& c) {
  f.choice("sides", c.sides, side_options(), {.meaning = "Walls that have pillars."});
  f.number("spacing", c.spacing,
           {.unit = "m", .range = at_least(0), .meaning = "Between centres; 0 for no pillars."});
  f.number("size", c.size,
           {.unit = "m", .range = in_range(0.02, 5.0), .meaning = "Along the wall."});
  f.number("depth", c.depth,
           {.unit = "m", .range = in_range(0.01, 1.0), .meaning = "Out of the wall."});
}

void describe(Fields& f, ClutterConfig& c) {
  f.number("density", c.density,
           {.unit = "1/m", .range = in_range(0.0, 10.0), .meaning = "Objects per metre."});
  f.number("lane_width", c.lane_width,
           {.unit = "m", .range = in_range(0.8, 10.0), .meaning = "Middle that stays free."});
}

void describe(Fields& f, BumpConfig& c) {
  f.number("height", c.height,
           {.unit = "m",
            .range = in_range(0.0, 0.02),
            .meaning = "Between the floor's lowest and highest point; 0 for a flat floor."});
  f.number("correlation_length", c.correlation_length,
           {.unit = "m", .range = in_range(0.2, 5.0), .meaning = "Of the floor's heights."});
}

void describe(Fields& f, CorridorConfig& c) {
  f.number("length", c.length,
           {.unit = "m",
            .range = in_range(1.0, 1000.0),
            .meaning = "Between the first and the last point of the route.",
            .source = "paper, indoor long corridor: 78.60 m"});
  f.number("margin", c.margin,
           {.unit = "m",
            .range = in_range(1.0, 500.0),
            .meaning = "Of corridor before the first and behind the last point."});
  f.number("width", c.width,
           {.unit = "m", .range = in_range(1.0, 20.0), .meaning = "Between the walls."});
  f.number("height", c.height,
           {.unit = "m", .range = in_range(1.0, 20.0), .meaning = "From floor to ceiling."});
  f.choice("end_walls", c.end_walls,
           {{"none", EndWalls::kNone},
            {"start", EndWalls::kStart},
            {"end", EndWalls::kEnd},
            {"both", EndWalls::kBoth}},
           {.meaning = "Ends closed by a wall; the others are open."});
  f.group("doors", c.doors);
  f.group("pillars", c.pillars);
  f.group("clutter", c.clutter);
  f.group("glass", c.glass);
}

void describe(Fields& f, SceneConfig& c) {
  f.choice("kind", c.kind,
           {{"corridor", SceneKind::kCorridor},
            {"garage", SceneKind::kGarage},
            {"junction", SceneKind::kJunction},
            {"tunnel", SceneKind::kTunnel}},
           {.meaning = "Which generator builds the surroundings."});
  f.integer("seed", c.seed,
            {.unit = "-",
             .range = at_least(0),
             .meaning = "Of jitter, clutter and bumps; 0 for the seed of the run."});
  f.number(
      "floor_friction", c.floor_friction,
      {.unit = "-", .range = in_range(0.05, 2.0), .meaning = "Sliding friction of the floor."});
  f.group("bumps", c.bumps);
  f.group("reflectivity", c.reflectivity);
  f.group("corridor", c.corridor);
  f.group("ramp", c.ramp);
  f.group("people", c.people);
  f.group("garage", c.garage);
  f.group("junction", c.junction);
  f.group("tunnel", c.tunnel);
}

namespace {

Result<void> validate_ramp(const SceneConfig& config) {
  const RampConfig& ramp = config.ramp;
  if (ramp.grade <= 0.0) return {};
  if (config.bumps.height > 0.0) return failure("scene.ramp: a floor with a ramp has no bumps");
  if (config.people.count > 0) return failure("scene.people: only on a level floor");
  const double room = config.corridor.length + config.corridor.margin - ramp.start;
  if (ramp.length > room) {
    return failure(
        fmt::format("scene.ramp.length: expected at most {} m (up to the corridor's end), got {}",
                    room, ramp.length));
  }
  return {};
}

/// People who walk up and down the corridor, a metre short of its ends.
std::vector<Person> corridor_people(const SceneConfig& config, std::uint64_t seed) {
  constexpr double kShort = 1.0;  ///< [m]
  const CorridorConfig& corridor = config.corridor;
  return people_in_lanes(config.people, kShort - corridor.margin,
                         corridor.length + corridor.margin - kShort, seed);
}

}  // namespace

Result<void> validate(const SceneConfig& config) {
  if (config.kind != SceneKind::kCorridor) {
    if (config.ramp.grade > 0.0) return failure("scene.ramp: only a corridor can have a ramp");
    if (config.people.count > 0) return failure("scene.people: only a corridor can have people");
  }
  switch (config.kind) {
    case SceneKind::kCorridor: {
      if (auto ok = validate_ramp(config); !ok) return ok;
      if (auto ok = validate(config.people, config.corridor.width); !ok) return ok;
      return validate(config.corridor);
    }
    case SceneKind::kGarage:
      return validate(config.garage);
    case SceneKind::kJunction:
      return validate(config.junction);
    case SceneKind::kTunnel:
      return validate(config.tunnel);
  }
  return failure("unknown kind of scene");
}

Scene build_scene(const SceneConfig& config, std::uint64_t run_seed) {
  const std::uint64_t seed = config.seed > 0 ? static_cast<std::uint64_t>(config.seed) : run_seed;
  Scene scene;
  switch (config.kind) {
    case SceneKind::kCorridor:
      scene.solids = corridor_solids(config.corridor, config.ramp, config.reflectivity, seed);
      scene.floor = corridor_floor(config.corridor);
      scene.people = corridor_people(config, seed);
      break;
    case SceneKind::kGarage:
      scene.solids = garage_solids(config.garage, config.reflectivity, seed);
      scene.floor = garage_floor(config.garage);
      break;
    case SceneKind::kJunction:
      scene.solids = junction_solids(config.junction, config.reflectivity, seed);
      scene.floor = junction_floor(config.junction);
      break;
    case SceneKind::kTunnel:
      scene.solids = tunnel_solids(config.tunnel, config.reflectivity, seed);
      scene.floor = tunnel_floor(config.tunnel);
      break;
  }
  scene.floor.material = {config.reflectivity.floor, {0.55F, 0.57F, 0.60F}};
  add_bumps(config.bumps, seed, scene.floor);
  add_ramp(config.ramp, scene.floor);
  return scene;
}

}  // namespace aims
