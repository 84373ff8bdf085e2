// SPDX-License-Identifier: BSD-3-Clause
#include "sim/environment/scene_config.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "core/random.hpp"
#include "sim/environment/corridor.hpp"
#include "sim/environment/corridor_pieces.hpp"
#include "sim/environment/stretches.hpp"

namespace aims {
void describe(Fields& f, PillarConfig& c) {
  f.choice("sides", c.sides, side_options(), {.meaning = "Walls with pillars, looking along +x."});
  f.number("spacing", c.spacing,
           {.unit = "m",
            .range = up_to(1000.0),
            .meaning = "Distance between the centres of two pillars on one wall; 0 for none."});
  f.number(
      "size", c.size,
      {.unit = "m", .range = in_range(0.02, 5.0), .meaning = "Length of a pillar along its wall."});
  f.number("depth", c.depth,
           {.unit = "m",
            .range = in_range(0.01, 1.0),
            .meaning = "Distance by which a pillar protrudes from its wall."});
}

void describe(Fields& f, ClutterConfig& c) {
  f.number("density", c.density,
           {.unit = "1/m",
            .range = in_range(0.0, 10.0),
            .meaning = "Objects along the walls per metre of corridor."});
  f.number("free_width", c.free_width,
           {.unit = "m",
            .range = in_range(0.8, 10.0),
            .meaning = "Width in the middle of the corridor without clutter."});
}

void describe(Fields& f, LampConfig& c) {
  f.number("spacing", c.spacing,
           {.unit = "m",
            .range = up_to(1000.0),
            .meaning = "Distance between the centres of lamps under the ceiling; 0 for none.",
            .source = "guides of lighting: about the height of the ceiling"});
  f.number("length", c.length,
           {.unit = "m",
            .range = in_range(0.05, 10.0),
            .meaning = "Length of a lamp along the corridor.",
            .source = "assumption"});
  f.number("width", c.width,
           {.unit = "m",
            .range = in_range(0.02, 2.0),
            .meaning = "Width of a lamp.",
            .source = "assumption"});
  f.number("height", c.height,
           {.unit = "m",
            .range = in_range(0.01, 0.5),
            .meaning = "Distance by which a lamp protrudes from the ceiling.",
            .source = "assumption"});
}

void describe(Fields& f, BumpConfig& c) {
  f.number(
      "height", c.height,
      {.unit = "m",
       .range = in_range(0.0, 0.02),
       .meaning = "Height between the lowest and the highest point of the floor; 0 for flat."});
  f.number("correlation_length", c.correlation_length,
           {.unit = "m",
            .range = in_range(0.2, 5.0),
            .meaning = "Correlation length of the floor's heights."});
}

void describe(Fields& f, BendConfig& c) {
  f.number("at", c.at,
           {.unit = "-",
            .range = in_range(0.02, 0.98),
            .meaning = "Position of the bend, as a fraction of the route's length."});
  f.number(
      "angle_deg", c.angle_deg,
      {.unit = "deg",
       .range = in_range(0.0, 180.0),
       .meaning = "Change of the corridor's direction; 0 for no bend. Beyond 90 two bends of half "
                  "the angle."});
  f.choice("side", c.side, {{"left", Side::kLeft}, {"right", Side::kRight}},
           {.meaning = "Side to which the corridor turns, looking from the start of the route."});
}

void describe(Fields& f, CorridorConfig& c) {
  f.number("length", c.length,
           {.unit = "m",
            .range = in_range(1.0, 1000.0),
            .meaning = "Length of the route, from its first point to its last.",
            .source = "paper, indoor long corridor: 78.60 m"});
  f.number("margin", c.margin,
           {.unit = "m",
            .range = in_range(1.0, 500.0),
            .meaning = "Length of corridor beyond either end of the route."});
  f.number("width", c.width,
           {.unit = "m",
            .range = in_range(1.0, 20.0),
            .meaning = "Width of the corridor between its walls."});
  f.number("height", c.height,
           {.unit = "m",
            .range = in_range(1.0, 20.0),
            .meaning = "Height of the corridor from floor to ceiling."});
  f.choice("end_walls", c.end_walls,
           {{"none", EndWalls::kNone},
            {"start", EndWalls::kStart},
            {"end", EndWalls::kEnd},
            {"both", EndWalls::kBoth}},
           {.meaning = "Ends of the corridor closed by a wall."});
  f.list("bends", c.bends, "Bends of the corridor in order; none in a straight one.");
  f.group("doors", c.doors);
  f.group("pillars", c.pillars);
  f.group("clutter", c.clutter);
  f.group("lamps", c.lamps);
  f.group("glass", c.glass);
}

void describe(Fields& f, SceneConfig& c) {
  f.choice("kind", c.kind,
           {{"corridor", SceneKind::kCorridor},
            {"garage", SceneKind::kGarage},
            {"junction", SceneKind::kJunction},
            {"tunnel", SceneKind::kTunnel},
            {"loop", SceneKind::kLoop}},
           {.meaning = "Type of environment to build."});
  f.integer("seed", c.seed,
            {.unit = "-",
             .range = in_range(0, 2147483647),
             .meaning = "Seed of door jitter, clutter and bumps; 0 uses the seed of the run."});
  f.number("floor_friction", c.floor_friction,
           {.unit = "-",
            .range = in_range(0.05, 2.0),
            .meaning = "Sliding friction coefficient of the floor."});
  f.group("bumps", c.bumps);
  f.group("reflectivity", c.reflectivity);
  f.group("surface", c.surface);
  f.group("corridor", c.corridor);
  f.group("ramp", c.ramp);
  f.group("people", c.people);
  f.group("garage", c.garage);
  f.group("junction", c.junction);
  f.group("tunnel", c.tunnel);
  f.group("loop", c.loop);
}

namespace {

constexpr int kWaves = 64;
constexpr double kCellsPerLength = 4.0;  ///< grid cells per correlation length

struct Wave {
  Eigen::Vector2d number;  ///< [rad/m]
  double phase;            ///< [rad]
};

/// Plane waves whose sum is close to a Gaussian field with that correlation length.
std::array<Wave, kWaves> random_waves(double correlation_length, std::uint64_t seed) {
  RandomStream random = rng(seed, "scene.bumps");
  std::array<Wave, kWaves> waves;
  for (Wave& wave : waves) {
    const Eigen::Vector3d normal = random.normal3();
    wave.number = normal.head<2>() / correlation_length;
    wave.phase = random.uniform(0.0, 2.0 * std::numbers::pi);
  }
  return waves;
}

/// The field's value mapped to (0, 1), evenly distributed.
double unit_height(const std::array<Wave, kWaves>& waves, const Eigen::Vector2d& point) {
  double sum = 0.0;
  for (const Wave& wave : waves) sum += std::cos(wave.number.dot(point) + wave.phase);
  const double sigma = std::sqrt(0.5 * kWaves);
  return 0.5 * std::erfc(-sum / (sigma * std::numbers::sqrt2));
}

constexpr double kMaxGridPoints = 2e6;

int grid_points(double length, double cell) {
  return std::max(2, static_cast<int>(std::ceil(length / cell)) + 1);
}

double cell_of(const BumpConfig& bumps) { return bumps.correlation_length / kCellsPerLength; }

/// Error when the floor would need more grid points than can be made in a few seconds.
Result<void> validate(const BumpConfig& bumps, const Floor& floor) {
  if (bumps.height <= 0.0) return {};
  const Eigen::Vector2d size = floor.max_corner - floor.min_corner;
  const double points = size.prod() / (cell_of(bumps) * cell_of(bumps));
  if (points <= kMaxGridPoints) return {};
  return failure(
      fmt::format("scene.bumps.correlation_length: expected at least {:.2g} m for a floor of "
                  "{:.0f} m x {:.0f} m "
                  "({:.0g} grid points), got {}",
                  kCellsPerLength * std::sqrt(size.prod() / kMaxGridPoints), size.x(), size.y(),
                  kMaxGridPoints, bumps.correlation_length));
}

/// Fills the floor's rectangle with smooth random heights in [0, bumps.height]; keeps it flat
/// when that is 0. Heights are correlated as exp(-d^2 / (2 correlation_length^2)).
void add_bumps(const BumpConfig& bumps, std::uint64_t seed, Floor& floor) {
  if (bumps.height <= 0.0) return;
  const Eigen::Vector2d size = floor.max_corner - floor.min_corner;
  const double cell = cell_of(bumps);
  floor.columns = grid_points(size.x(), cell);
  floor.rows = grid_points(size.y(), cell);
  const auto waves = random_waves(bumps.correlation_length, seed);
  const Eigen::Vector2d step(size.x() / (floor.columns - 1), size.y() / (floor.rows - 1));
  floor.heights.clear();
  for (int row = 0; row < floor.rows; ++row) {
    for (int column = 0; column < floor.columns; ++column) {
      const Eigen::Vector2d point =
          floor.min_corner + step.cwiseProduct(Eigen::Vector2d(column, row));
      floor.heights.push_back(static_cast<float>(bumps.height * unit_height(waves, point)));
    }
  }
}

Result<void> validate_ramp(const SceneConfig& config) {
  const RampConfig& ramp = config.ramp;
  if (ramp.grade <= 0.0) return {};
  if (has_bends(config.corridor))
    return failure("scene.ramp.grade: expected 0 (no ramp) in a corridor with bends");
  if (config.bumps.height > 0.0)
    return failure("scene.ramp: a floor with a ramp cannot have bumps (scene.bumps)");
  const double room = config.corridor.length + config.corridor.margin - ramp.start;
  if (ramp.length > room) {
    return failure(
        fmt::format("scene.ramp.length: expected at most {} m (up to the corridor's end), got {}",
                    room, ramp.length));
  }
  return {};
}

/// The part of the scene's kind.
Result<void> validate_kind(const SceneConfig& config) {
  switch (config.kind) {
    case SceneKind::kCorridor: {
      if (auto ok = validate_ramp(config); !ok) return ok;
      return validate(config.corridor);
    }
    case SceneKind::kGarage:
      return validate(config.garage);
    case SceneKind::kJunction:
      return validate(config.junction);
    case SceneKind::kTunnel:
      return validate(config.tunnel);
    case SceneKind::kLoop:
      return validate(config.loop);
  }
  return failure("unknown kind of scene");
}

Floor flat_floor(const SceneConfig& config) {
  switch (config.kind) {
    case SceneKind::kCorridor:
      return corridor_floor(config.corridor);
    case SceneKind::kGarage:
      return garage_floor(config.garage);
    case SceneKind::kJunction:
      return junction_floor(config.junction);
    case SceneKind::kTunnel:
      return tunnel_floor(config.tunnel);
    case SceneKind::kLoop:
      return loop_floor(config.loop);
  }
  return {};
}

}  // namespace

Result<void> validate(const SceneConfig& config) {
  if (config.kind != SceneKind::kCorridor && config.ramp.grade > 0.0) {
    return failure("scene.ramp: only a scene of kind corridor can have a ramp");
  }
  if (auto ok = validate_kind(config); !ok) return ok;
  if (auto ok = validate_people(config); !ok) return ok;
  if (auto ok = validate(config.surface); !ok) return ok;
  return validate(config.bumps, flat_floor(config));
}

Scene build_scene(const SceneConfig& config, std::uint64_t run_seed) {
  const std::uint64_t seed = config.seed > 0 ? static_cast<std::uint64_t>(config.seed) : run_seed;
  Scene scene;
  scene.floor = flat_floor(config);
  switch (config.kind) {
    case SceneKind::kCorridor:
      scene.solids = corridor_solids(config.corridor, config.ramp, config.reflectivity, seed);
      break;
    case SceneKind::kGarage:
      scene.solids = garage_solids(config.garage, config.reflectivity, seed);
      break;
    case SceneKind::kJunction:
      scene.solids = junction_solids(config.junction, config.reflectivity, seed);
      break;
    case SceneKind::kTunnel:
      scene.solids = tunnel_solids(config.tunnel, config.reflectivity, seed);
      break;
    case SceneKind::kLoop:
      scene.solids = loop_solids(config.loop, config.reflectivity, seed);
      break;
  }
  if (config.people.count > 0) scene.people = people_on(stretches_of(config), config.people, seed);
  scene.floor.material = {config.reflectivity.floor, {0.55F, 0.57F, 0.60F}};
  scene.surface = config.surface;
  scene.surface_seed = seed;
  add_bumps(config.bumps, seed, scene.floor);
  add_ramp(config.ramp, scene.floor);
  return scene;
}

}  // namespace aims
