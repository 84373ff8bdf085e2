// SPDX-License-Identifier: BSD-3-Clause
#include "sim/environment/corridor.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace aims {
namespace {

constexpr double kWallThickness = 0.2;   ///< of plain and end walls [m]
constexpr double kOverlap = 0.05;        ///< of pieces behind visible faces, against leaks [m]
constexpr double kDoorThickness = 0.05;  ///< [m]
constexpr int kMaxPillars = 40;          ///< they collide, and physics must stay fast
constexpr double kWalkway = 1.0;         ///< that pillars must leave free [m]

enum class Side { kLeft, kRight };

/// An interval along the corridor [m].
struct Span {
  double begin = 0.0;
  double end = 0.0;
  double centre() const { return 0.5 * (begin + end); }
};

struct Materials {
  Material wall, ceiling, door, pillar, clutter;
};

Materials corridor_materials(const ReflectivityConfig& reflectivity) {
  return {.wall = {reflectivity.wall, {0.86F, 0.85F, 0.80F}},
          .ceiling = {reflectivity.ceiling, {0.93F, 0.93F, 0.92F}},
          .door = {reflectivity.door, {0.50F, 0.31F, 0.17F}},
          .pillar = {reflectivity.wall, {0.72F, 0.74F, 0.76F}},
          .clutter = {reflectivity.clutter, {0.25F, 0.42F, 0.56F}}};
}

Span extent(const CorridorConfig& config) {
  return {-config.margin, config.length + config.margin};
}

bool has_end(const CorridorConfig& config, EndWalls end) {
  return config.end_walls == end || config.end_walls == EndWalls::kBoth;
}

/// Whether the feature number `index` along a wall is on that side.
bool on_side(WallSides sides, Side side, int index) {
  switch (sides) {
    case WallSides::kNone:
      return false;
    case WallSides::kLeft:
      return side == Side::kLeft;
    case WallSides::kRight:
      return side == Side::kRight;
    case WallSides::kBoth:
      return true;
    case WallSides::kAlternate:
      return (index % 2 == 0) == (side == Side::kLeft);
  }
  return false;
}

/// Centres of features `spacing` apart, the first half a spacing behind the corridor's begin.
std::vector<double> regular_centres(const Span& along, double spacing) {
  std::vector<double> centres;
  for (double x = along.begin + 0.5 * spacing; x < along.end; x += spacing) centres.push_back(x);
  return centres;
}

/// Openings of the doors in one wall, in order along x, clear of the corridor's ends.
std::vector<Span> door_openings(const CorridorConfig& config, Side side, std::uint64_t seed) {
  const DoorConfig& doors = config.doors;
  RandomStream random = rng(seed, side == Side::kLeft ? "scene.doors.left" : "scene.doors.right");
  const Span along = extent(config);
  std::vector<Span> openings;
  const double reach = 0.5 * doors.width + doors.jitter + kWallThickness;
  int index = 0;
  for (const double centre : regular_centres(along, doors.spacing)) {
    const double x = centre + random.uniform(-doors.jitter, doors.jitter);
    const bool fits = centre - reach > along.begin && centre + reach < along.end;
    if (on_side(doors.sides, side, index++) && fits) {
      openings.push_back({x - 0.5 * doors.width, x + 0.5 * doors.width});
    }
  }
  return openings;
}

/// Adds boxes on one side of the corridor, given by their distances from the centre line.
class SideBuilder {
 public:
  SideBuilder(const CorridorConfig& config, Side side, std::vector<Solid>& solids)
      : sign_(side == Side::kLeft ? 1.0 : -1.0), face_(0.5 * config.width), solids_(solids) {}

  /// A box along `x`, from `near` to `far` behind the wall's face, between two heights.
  Solid& box(const Span& x, double near, double far, double bottom, double top,
             const Material& material) {
    Solid solid;
    solid.T_world_solid.translation = {x.centre(), sign_ * (face_ + 0.5 * (near + far)),
                                       0.5 * (bottom + top)};
    solid.half_extents = {0.5 * (x.end - x.begin), 0.5 * (far - near), 0.5 * (top - bottom)};
    solid.material = material;
    solid.collides = false;
    return solids_.emplace_back(solid);
  }

 private:
  double sign_;
  double face_;
  std::vector<Solid>& solids_;
};

/// One long wall: a colliding slab that nobody sees, and the pieces that are seen.
void add_wall(const CorridorConfig& config, const std::vector<Span>& openings,
              const Materials& materials, SideBuilder& side) {
  const Span along = extent(config);
  const Span outer{along.begin - kWallThickness, along.end + kWallThickness};
  Solid& slab = side.box(outer, 0.0, kWallThickness, 0.0, config.height, materials.wall);
  slab.collides = true;
  slab.visible = false;
  const double top = config.height + kOverlap;
  if (openings.empty()) {
    side.box(outer, 0.0, kWallThickness, -kOverlap, top, materials.wall);
    return;
  }
  const double depth = config.doors.depth;
  const double back = depth + kDoorThickness;
  side.box(outer, depth + 0.5 * kDoorThickness, back + kWallThickness, -kOverlap, top,
           materials.wall);
  double begin = outer.begin;
  for (const Span& opening : openings) {
    side.box({begin, opening.begin}, 0.0, back, -kOverlap, top, materials.wall);
    const Span behind{opening.begin - kOverlap, opening.end + kOverlap};
    side.box(behind, depth, back, -kOverlap, config.doors.height + kOverlap, materials.door);
    if (config.doors.height < config.height) {
      side.box(opening, 0.0, back, config.doors.height, top, materials.wall);
    }
    begin = opening.end;
  }
  side.box({begin, outer.end}, 0.0, back, -kOverlap, top, materials.wall);
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

void add_pillars(const CorridorConfig& config, const std::vector<Span>& spans,
                 const Materials& materials, SideBuilder& side) {
  for (const Span& span : spans) {
    Solid& pillar = side.box(span, -config.pillars.depth, kOverlap, -kOverlap,
                             config.height + kOverlap, materials.pillar);
    pillar.collides = true;
  }
}

/// One box or cylinder that touches the wall and stays out of the lane.
Solid clutter_object(const CorridorConfig& config, double x, const Material& material,
                     RandomStream& random) {
  const double room = 0.5 * (config.width - config.clutter.lane_width);
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

void add_clutter(const CorridorConfig& config, const Material& material, std::uint64_t seed,
                 std::vector<Solid>& solids) {
  RandomStream random = rng(seed, "scene.clutter");
  const Span along = extent(config);
  const auto count = std::lround(config.clutter.density * (along.end - along.begin));
  for (long i = 0; i < count; ++i) {
    const double x = random.uniform(along.begin, along.end);
    solids.push_back(clutter_object(config, x, material, random));
  }
}

/// A box across the corridor, from wall to wall and beyond.
Solid cross_box(const CorridorConfig& config, const Span& x, double bottom, double top,
                const Material& material) {
  Solid solid;
  const double half_width =
      0.5 * config.width + std::max(config.doors.depth, 0.0) + kWallThickness + kDoorThickness;
  solid.T_world_solid.translation = {x.centre(), 0.0, 0.5 * (bottom + top)};
  solid.half_extents = {0.5 * (x.end - x.begin), half_width, 0.5 * (top - bottom)};
  solid.material = material;
  return solid;
}

void add_ends_and_ceiling(const CorridorConfig& config, const Materials& materials,
                          std::vector<Solid>& solids) {
  const Span along = extent(config);
  const double top = config.height + kOverlap;
  if (has_end(config, EndWalls::kStart)) {
    solids.push_back(cross_box(config, {along.begin - kWallThickness, along.begin}, -kOverlap, top,
                               materials.wall));
  }
  if (has_end(config, EndWalls::kEnd)) {
    solids.push_back(
        cross_box(config, {along.end, along.end + kWallThickness}, -kOverlap, top, materials.wall));
  }
  Solid ceiling = cross_box(config, {along.begin - kWallThickness, along.end + kWallThickness},
                            config.height, config.height + kWallThickness, materials.ceiling);
  ceiling.collides = false;
  ceiling.roof = true;
  solids.push_back(ceiling);
}

Result<void> validate_doors(const CorridorConfig& config) {
  const DoorConfig& doors = config.doors;
  if (doors.sides == WallSides::kNone) return {};
  if (doors.width + 2.0 * doors.jitter >= doors.spacing) {
    return failure(
        fmt::format("scene.corridor.doors.spacing: expected more than {} m (width and twice the "
                    "jitter), got {}",
                    doors.width + 2.0 * doors.jitter, doors.spacing));
  }
  if (doors.height > config.height) {
    return failure(fmt::format(
        "scene.corridor.doors.height: expected at most {} m (the corridor's height), got {}",
        config.height, doors.height));
  }
  return {};
}

Result<void> validate_pillars(const CorridorConfig& config) {
  const PillarConfig& pillars = config.pillars;
  if (pillars.spacing <= 0.0 || pillars.sides == WallSides::kNone) return {};
  const Span along = extent(config);
  const double walls = pillars.sides == WallSides::kBoth ? 2.0 : 1.0;
  const double closest = std::max(pillars.size, walls * (along.end - along.begin) / kMaxPillars);
  if (pillars.spacing <= closest) {
    return failure(fmt::format(
        "scene.corridor.pillars.spacing: expected more than {:.2f} m (their size, and at most {} "
        "pillars), got {}",
        closest, kMaxPillars, pillars.spacing));
  }
  const double deepest = 0.5 * (config.width - kWalkway);
  if (pillars.depth > deepest) {
    return failure(fmt::format(
        "scene.corridor.pillars.depth: expected at most {:.2f} m (to leave {} m to walk), got {}",
        deepest, kWalkway, pillars.depth));
  }
  return {};
}

}  // namespace

Result<void> validate(const CorridorConfig& config) {
  if (const auto doors = validate_doors(config); !doors) return doors;
  if (const auto pillars = validate_pillars(config); !pillars) return pillars;
  const double widest = config.width - 0.2;
  if (config.clutter.density > 0.0 && config.clutter.lane_width > widest) {
    return failure(fmt::format(
        "scene.corridor.clutter.lane_width: expected at most {:.2f} m (room for clutter), got {}",
        widest, config.clutter.lane_width));
  }
  return {};
}

std::vector<Solid> corridor_solids(const CorridorConfig& config,
                                   const ReflectivityConfig& reflectivity, std::uint64_t seed) {
  const Materials materials = corridor_materials(reflectivity);
  std::vector<Solid> solids;
  for (const Side which : {Side::kLeft, Side::kRight}) {
    SideBuilder side(config, which, solids);
    const std::vector<Span> openings = door_openings(config, which, seed);
    add_wall(config, openings, materials, side);
    add_pillars(config, pillar_spans(config, which, openings), materials, side);
  }
  add_ends_and_ceiling(config, materials, solids);
  add_clutter(config, materials.clutter, seed, solids);
  return solids;
}

Floor corridor_floor(const CorridorConfig& config) {
  const Span along = extent(config);
  const double half_width =
      0.5 * config.width + config.doors.depth + kWallThickness + kDoorThickness;
  Floor floor;
  floor.min_corner = {along.begin - kWallThickness, -half_width};
  floor.max_corner = {along.end + kWallThickness, half_width};
  return floor;
}

}  // namespace aims
