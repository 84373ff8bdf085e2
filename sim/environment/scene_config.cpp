// SPDX-License-Identifier: BSD-3-Clause
#include "sim/environment/scene_config.hpp"

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
}

void describe(Fields& f, SceneConfig& c) {
  f.choice("kind", c.kind, {{"corridor", SceneKind::kCorridor}, {"garage", SceneKind::kGarage}},
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
  f.group("garage", c.garage);
}

Result<void> validate(const SceneConfig& config) {
  switch (config.kind) {
    case SceneKind::kCorridor:
      return validate(config.corridor);
    case SceneKind::kGarage:
      return validate(config.garage);
  }
  return failure("unknown kind of scene");
}

Scene build_scene(const SceneConfig& config, std::uint64_t run_seed) {
  const std::uint64_t seed = config.seed > 0 ? static_cast<std::uint64_t>(config.seed) : run_seed;
  Scene scene;
  switch (config.kind) {
    case SceneKind::kCorridor:
      scene.solids = corridor_solids(config.corridor, config.reflectivity, seed);
      scene.floor = corridor_floor(config.corridor);
      break;
    case SceneKind::kGarage:
      scene.solids = garage_solids(config.garage, config.reflectivity, seed);
      scene.floor = garage_floor(config.garage);
      break;
  }
  scene.floor.material = {config.reflectivity.floor, {0.55F, 0.57F, 0.60F}};
  add_bumps(config.bumps, seed, scene.floor);
  return scene;
}

}  // namespace aims
