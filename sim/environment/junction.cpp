// SPDX-License-Identifier: BSD-3-Clause
#include "sim/environment/junction.hpp"

#include <numbers>
#include <string>

#include "sim/environment/wall.hpp"

namespace aims {
namespace {

/// A corridor with doors and an end wall.
CorridorArm arm_with_doors(const JunctionConfig& c, const Span& along, std::uint64_t seed,
                           const std::string& name) {
  const std::string stream = "scene.junction.doors." + name;
  CorridorArm arm;
  arm.along = along;
  arm.width = c.width;
  arm.height = c.height;
  arm.begin_closed = true;
  arm.door_depth = c.doors.depth;
  arm.left = openings_at(door_openings(c.doors, along, Side::kLeft, seed, stream + ".left"),
                         c.doors.height);
  arm.right = openings_at(door_openings(c.doors, along, Side::kRight, seed, stream + ".right"),
                          c.doors.height);
  return arm;
}

}  // namespace

void describe(Fields& f, JunctionConfig& c) {
  f.number(
      "length", c.length,
      {.unit = "m",
       .range = in_range(4.0, 500.0),
       .meaning = "Distance from the first point to the centre line of the crossing corridor."});
  f.number(
      "branch", c.branch,
      {.unit = "m",
       .range = in_range(4.0, 500.0),
       .meaning = "Length of either branch of the crossing corridor, up to its last route point."});
  f.number("margin", c.margin,
           {.unit = "m",
            .range = in_range(1.0, 500.0),
            .meaning = "Length of corridor beyond the end points of the route."});
  f.number("width", c.width,
           {.unit = "m",
            .range = in_range(1.0, 4.0),
            .meaning = "Width of both corridors between their walls."});
  f.number("height", c.height,
           {.unit = "m",
            .range = in_range(1.0, 20.0),
            .meaning = "Height of both corridors from floor to ceiling."});
  f.group("doors", c.doors);
}

Result<void> validate(const JunctionConfig& config) {
  return validate_doors(config.doors, config.height, "scene.junction.doors");
}

std::vector<Solid> junction_solids(const JunctionConfig& config,
                                   const ReflectivityConfig& reflectivity, std::uint64_t seed) {
  const Materials materials = building_materials(reflectivity);
  std::vector<Solid> solids;
  const Span stem{-config.margin, config.length - 0.5 * config.width};
  add_arm(arm_with_doors(config, stem, seed, "stem"), materials, solids);

  const double half = config.branch + config.margin;
  CorridorArm crossing = arm_with_doors(config, {-half, half}, seed, "crossing");
  crossing.T_world_arm = line_at(config.length, 0.0, 0.5 * std::numbers::pi);
  crossing.end_closed = true;
  const double mouth = 0.5 * config.width + kOverlap;
  crossing.left_gap = Span{-mouth, mouth};
  add_arm(crossing, materials, solids);
  return solids;
}

Floor junction_floor(const JunctionConfig& config) {
  constexpr double kBeyond = 2.0;  ///< outside of every wall's face [m]
  const double half = config.branch + config.margin + kBeyond;
  Floor floor;
  floor.min_corner = {-config.margin - kBeyond, -half};
  floor.max_corner = {config.length + 0.5 * config.width + kBeyond, half};
  return floor;
}

}  // namespace aims
