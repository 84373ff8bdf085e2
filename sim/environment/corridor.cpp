// SPDX-License-Identifier: BSD-3-Clause
#include "sim/environment/corridor.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/random.hpp"
#include "sim/environment/bent_corridor.hpp"
#include "sim/environment/corridor_pieces.hpp"
#include "sim/environment/wall.hpp"

namespace aims {
namespace {

constexpr int kMaxPillars = 40;   ///< each collides, which costs physics time
constexpr double kWalkway = 1.0;  ///< width that pillars must leave free [m]

Span extent(const CorridorConfig& config) {
  return {-config.margin, config.length + config.margin};
}

/// The extent with its end walls, whether they are built or not.
Span outer_extent(const CorridorConfig& config) {
  const Span along = extent(config);
  return {along.begin - kWallThickness, along.end + kWallThickness};
}

/// The pillars of one wall that do not stand in front of a door, as spans along x.
std::vector<Span> pillar_spans(const CorridorConfig& config, Side which,
                               const std::vector<Span>& openings) {
  const PillarConfig& pillars = config.pillars;
  std::vector<Span> spans;
  if (pillars.spacing <= 0.0) return spans;
  const Span along = extent(config);
  int index = 0;
  for (double x = along.begin + pillars.spacing; x < along.end; x += pillars.spacing) {
    const Span span{x - 0.5 * pillars.size, x + 0.5 * pillars.size};
    const bool free = std::none_of(openings.begin(), openings.end(), [&](const Span& opening) {
      return span.begin < opening.end && opening.begin < span.end;
    });
    if (on_side(pillars.sides, which, index++) && free) spans.push_back(span);
  }
  return spans;
}

void add_pillars(const CorridorConfig& config, double height, const std::vector<Span>& spans,
                 const Materials& materials, SideBuilder& side) {
  for (const Span& span : spans) {
    Solid& pillar = side.box(span, -config.pillars.depth, kOverlap, -kOverlap, height + kOverlap,
                             materials.pillar);
    pillar.collides = true;
  }
}

void add_clutter(const CorridorConfig& config, const RampConfig& ramp, const Material& material,
                 std::uint64_t seed, std::vector<Solid>& solids) {
  RandomStream random = rng(seed, "scene.clutter");
  const Span along = extent(config);
  const auto count = std::lround(config.clutter.density * (along.end - along.begin));
  for (long i = 0; i < count; ++i) {
    const double x = random.uniform(along.begin, along.end);
    solids.push_back(clutter_object(config, x, material, random));
    solids.back().T_world_solid.translation.z() += ramp_height(ramp, x);
  }
}

/// Lamps at every multiple of the spacing.
void add_lamps(const CorridorConfig& config, const Material& material, std::vector<Solid>& solids) {
  const LampConfig& lamps = config.lamps;
  if (lamps.spacing <= 0.0) return;
  const Span along = extent(config);
  const double half = 0.5 * lamps.length;
  for (auto i = std::lround(std::ceil((along.begin + half) / lamps.spacing));
       static_cast<double>(i) * lamps.spacing + half <= along.end; ++i) {
    const double x = static_cast<double>(i) * lamps.spacing;
    Solid& lamp = solids.emplace_back(cross_box({}, {x - half, x + half}, 0.5 * lamps.width,
                                                config.height - lamps.height,
                                                config.height + kOverlap, material));
    lamp.collides = false;
    lamp.roof = true;
  }
}

/// Half width of end walls and ceiling: they also cover the space behind glass.
double closed_half_width(const CorridorConfig& config) {
  const double walls = outer_half_width(config.width, config.doors.depth);
  if (config.glass.fraction <= 0.0) return walls;
  return std::max(walls, 0.5 * config.width + config.glass.backing_distance + kWallThickness);
}

void add_ends(const CorridorConfig& config, double height, const Materials& materials,
              std::vector<Solid>& solids) {
  const Span along = extent(config);
  const Span outer = outer_extent(config);
  const double half_width = closed_half_width(config);
  const double top = height + kOverlap;
  if (has_end(config, EndWalls::kStart)) {
    solids.push_back(
        cross_box({}, {outer.begin, along.begin}, half_width, -kOverlap, top, materials.wall));
  }
  if (has_end(config, EndWalls::kEnd)) {
    solids.push_back(
        cross_box({}, {along.end, outer.end}, half_width, -kOverlap, top, materials.wall));
  }
}

Solid ceiling_piece(const CorridorConfig& config, const Pose& T_world_line, const Span& x,
                    double bottom, const Materials& materials) {
  Solid ceiling = cross_box(T_world_line, x, closed_half_width(config), bottom,
                            bottom + kWallThickness, materials.ceiling);
  ceiling.collides = false;
  ceiling.roof = true;
  return ceiling;
}

/// One level piece; over a ramp three, which keep the corridor's height over the floor.
void add_ceiling(const CorridorConfig& config, const RampConfig& ramp, const Materials& materials,
                 std::vector<Solid>& solids) {
  const Span outer = outer_extent(config);
  if (ramp.grade <= 0.0) {
    solids.push_back(ceiling_piece(config, {}, outer, config.height, materials));
    return;
  }
  const double end = ramp.start + ramp.length;
  const double slope = std::atan(ramp.grade);
  const Eigen::AngleAxisd tilt(-slope, Eigen::Vector3d::UnitY());
  const Pose T_world_slope{Eigen::Quaterniond(tilt), {ramp.start, 0.0, config.height}};
  solids.push_back(ceiling_piece(config, {}, {outer.begin, ramp.start}, config.height, materials));
  solids.push_back(
      ceiling_piece(config, T_world_slope, {0.0, ramp.length / std::cos(slope)}, 0.0, materials));
  // Its bottom lies above the slope's where the two overlap.
  solids.push_back(ceiling_piece(config, {}, {end - kOverlap, outer.end},
                                 config.height + ramp_rise(ramp), materials));
}

/// Doors stand on the floor under their middle.
std::vector<Opening> openings_over(const std::vector<Span>& doors, double height,
                                   const RampConfig& ramp) {
  std::vector<Opening> openings;
  for (const Span& door : doors) {
    openings.push_back({door, height + ramp_height(ramp, door.centre())});
  }
  return openings;
}

/// One wall with doors and glass, and behind glass a second wall without end.
void add_side(const CorridorConfig& config, const RampConfig& ramp, Side which,
              const std::vector<Span>& doors, const Materials& materials,
              std::vector<Solid>& solids) {
  const double height = config.height + ramp_rise(ramp);
  const Span outer = outer_extent(config);
  SideBuilder side({}, which, 0.5 * config.width, solids);
  add_wall({outer, height, openings_over(doors, config.doors.height, ramp), config.doors.depth,
            glass_panes(config.glass, extent(config), doors)},
           materials, side);
  if (config.glass.fraction > 0.0) {
    const double backing = config.glass.backing_distance;
    side.box(outer, backing, backing + kWallThickness, -kOverlap, height + kOverlap,
             materials.wall);
  }
  add_pillars(config, height, pillar_spans(config, which, doors), materials, side);
}

Result<void> validate_pillars(const CorridorConfig& config) {
  const PillarConfig& pillars = config.pillars;
  if (pillars.spacing <= 0.0 || pillars.sides == WallSides::kNone) return {};
  const Span along = extent(config);
  const double walls = pillars.sides == WallSides::kBoth ? 2.0 : 1.0;
  const double min_spacing =
      std::max(pillars.size, walls * (along.end - along.begin) / kMaxPillars);
  if (pillars.spacing <= min_spacing) {
    return failure(fmt::format(
        "scene.corridor.pillars.spacing: expected more than {:.2f} m (their size, and at most {} "
        "pillars), got {}",
        min_spacing, kMaxPillars, pillars.spacing));
  }
  const double max_depth = 0.5 * (config.width - kWalkway);
  if (pillars.depth > max_depth) {
    return failure(fmt::format(
        "scene.corridor.pillars.depth: expected at most {:.2f} m (to leave {} m to walk), got {}",
        max_depth, kWalkway, pillars.depth));
  }
  return {};
}

}  // namespace

bool has_end(const CorridorConfig& config, EndWalls end) {
  return config.end_walls == end || config.end_walls == EndWalls::kBoth;
}

Solid clutter_object(const CorridorConfig& config, double x, const Material& material,
                     RandomStream& random) {
  const double room = 0.5 * (config.width - config.clutter.free_width);
  Solid solid;
  solid.shape = random.chance(0.4) ? Shape::kCylinder : Shape::kBox;
  const double depth = random.uniform(0.4, 1.0) * std::min(room, 0.4);
  const double length = solid.shape == Shape::kCylinder ? depth : random.uniform(0.2, 0.7);
  const double height = random.uniform(0.3, std::min(1.5, config.height));
  const double sign = random.chance(0.5) ? 1.0 : -1.0;
  solid.half_extents = 0.5 * Eigen::Vector3d(length, depth, height);
  solid.T_world_solid.translation = {x, sign * 0.5 * (config.width - depth), 0.5 * height};
  solid.material = material;
  const auto shade = static_cast<float>(random.uniform(0.6, 1.4));
  solid.material.color = (shade * material.color).cwiseMin(1.0F);
  solid.collides = false;
  return solid;
}

Result<void> validate(const CorridorConfig& config) {
  if (auto bends = validate_bends(config); !bends) return bends;
  if (const auto doors = validate_doors(config.doors, config.height, "scene.corridor.doors");
      !doors) {
    return doors;
  }
  if (const auto pillars = validate_pillars(config); !pillars) return pillars;
  if (config.glass.fraction > 0.0) {
    const double min_distance = config.doors.depth + kDoorThickness + kWallThickness;
    if (config.glass.backing_distance <= min_distance) {
      return failure(fmt::format(
          "scene.corridor.glass.backing_distance: expected more than {} m (the wall), got {}",
          min_distance, config.glass.backing_distance));
    }
  }
  if (config.lamps.spacing > 0.0 && config.lamps.length >= config.lamps.spacing) {
    return failure(fmt::format(
        "scene.corridor.lamps.length: expected less than scene.corridor.lamps.spacing ({} m), got "
        "{} m",
        config.lamps.spacing, config.lamps.length));
  }
  const double max_width = config.width - 0.2;
  if (config.clutter.density > 0.0 && config.clutter.free_width > max_width) {
    return failure(
        fmt::format("scene.corridor.clutter.free_width: expected at most {:.2f} m (to leave room "
                    "for clutter), got {}",
                    max_width, config.clutter.free_width));
  }
  return {};
}

std::vector<Solid> corridor_solids(const CorridorConfig& config, const RampConfig& ramp,
                                   const ReflectivityConfig& reflectivity, std::uint64_t seed) {
  Materials materials = building_materials(reflectivity);
  materials.glass = glass_material(config.glass);
  if (has_bends(config)) return bent_corridor_solids(config, materials, seed);
  std::vector<Solid> solids;
  for (const Side which : {Side::kLeft, Side::kRight}) {
    const char* stream = which == Side::kLeft ? "scene.doors.left" : "scene.doors.right";
    const auto doors = door_openings(config.doors, extent(config), which, seed, stream);
    add_side(config, ramp, which, doors, materials, solids);
  }
  add_ends(config, config.height + ramp_rise(ramp), materials, solids);
  add_ceiling(config, ramp, materials, solids);
  add_clutter(config, ramp, materials.clutter, seed, solids);
  add_lamps(config, materials.ceiling, solids);
  return solids;
}

Floor corridor_floor(const CorridorConfig& config) {
  if (has_bends(config)) return floor_under(corridor_pieces(config), config);
  const Span along = extent(config);
  const double half_width = closed_half_width(config);
  Floor floor;
  floor.min_corner = {along.begin - kWallThickness, -half_width};
  floor.max_corner = {along.end + kWallThickness, half_width};
  return floor;
}

}  // namespace aims
