// SPDX-License-Identifier: BSD-3-Clause
#include "sim/environment/loop.hpp"

#include <fmt/format.h>

#include <numbers>

#include "sim/environment/bent_corridor.hpp"
#include "sim/environment/corridor_pieces.hpp"
#include "sim/environment/wall.hpp"

namespace aims {
namespace {

constexpr double kQuarterTurn = 0.5 * std::numbers::pi;
constexpr double kLeastBlock = 1.0;  ///< between the walls of the block in the middle [m]

/// The corridor that the sides are pieces of.
CorridorConfig corridor_of(const LoopConfig& config) {
  CorridorConfig corridor;
  corridor.width = config.width;
  corridor.height = config.height;
  corridor.doors = config.doors;
  return corridor;
}

}  // namespace

void describe(Fields& f, LoopConfig& c) {
  f.number("length", c.length,
           {.unit = "m",
            .range = in_range(4.0, 500.0),
            .meaning = "Length of the sides along x, on the centre line."});
  f.number("depth", c.depth,
           {.unit = "m",
            .range = in_range(4.0, 500.0),
            .meaning = "Length of the sides along y, on the centre line."});
  f.integer("laps", c.laps,
            {.unit = "-",
             .range = in_range(1, 20),
             .meaning = "Times that a route with follow_scene goes around."});
  f.number("width", c.width,
           {.unit = "m",
            .range = in_range(1.0, 6.0),
            .meaning = "Width of the corridor between its walls."});
  f.number("height", c.height,
           {.unit = "m",
            .range = in_range(1.0, 20.0),
            .meaning = "Height of the corridor from floor to ceiling."});
  f.group("doors", c.doors);
}

Result<void> validate(const LoopConfig& config) {
  const double least =
      config.width + 2.0 * (config.doors.depth + kDoorThickness + kWallThickness) + kLeastBlock;
  for (const auto& [key, value] : {std::pair("length", config.length), {"depth", config.depth}}) {
    if (value >= least) continue;
    return failure(fmt::format(
        "scene.loop.{}: expected at least {:.2f} m (the corridor and a block of 1 m with its "
        "walls), got {}",
        key, least, value));
  }
  return validate_doors(config.doors, config.height, "scene.loop.doors");
}

std::vector<CorridorPiece> loop_pieces(const LoopConfig& config) {
  const double x = 0.5 * config.length;
  return {
      {line_at(-x, 0.0, 0.0), {0.0, config.length}, kQuarterTurn, kQuarterTurn},
      {line_at(x, 0.0, kQuarterTurn), {0.0, config.depth}, kQuarterTurn, kQuarterTurn},
      {line_at(x, config.depth, 2.0 * kQuarterTurn),
       {0.0, config.length},
       kQuarterTurn,
       kQuarterTurn},
      {line_at(-x, config.depth, -kQuarterTurn), {0.0, config.depth}, kQuarterTurn, kQuarterTurn}};
}

std::vector<Solid> loop_solids(const LoopConfig& config, const ReflectivityConfig& reflectivity,
                               std::uint64_t seed) {
  std::vector<Solid> solids;
  add_pieces(loop_pieces(config), corridor_of(config), building_materials(reflectivity), seed,
             solids);
  return solids;
}

Floor loop_floor(const LoopConfig& config) {
  return floor_under(loop_pieces(config), corridor_of(config));
}

}  // namespace aims
