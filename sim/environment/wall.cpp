// SPDX-License-Identifier: BSD-3-Clause
#include "sim/environment/wall.hpp"

#include <fmt/format.h>
#include <algorithm>
#include <cmath>

#include "core/angle.hpp"
#include "core/random.hpp"

namespace aims {

namespace {

/// Centres of features `spacing` apart, the first half a spacing from the start of the wall.
std::vector<double> regular_centres(const Span& along, double spacing) {
  std::vector<double> centres;
  for (double x = along.begin + 0.5 * spacing; x < along.end; x += spacing) centres.push_back(x);
  return centres;
}

/// A wall without glass: plain, or with doors and a slab behind them.
void add_solid_faces(const Wall& wall, const Materials& materials, SideBuilder& side) {
  const double top = wall.height + kOverlap;
  if (wall.openings.empty()) {
    side.box(wall.outer, 0.0, kWallThickness, -kOverlap, top, materials.wall);
    return;
  }
  const double depth = wall.door_depth;
  const double back = depth + kDoorThickness;
  side.box(wall.outer, depth + 0.5 * kDoorThickness, wall_depth(wall), -kOverlap, top,
           materials.wall);
  double begin = wall.outer.begin;
  for (const Opening& opening : wall.openings) {
    const Span& along = opening.along;
    side.box({begin, along.begin}, 0.0, back, -kOverlap, top, materials.wall);
    const Span behind{along.begin - kOverlap, along.end + kOverlap};
    side.box(behind, depth, back, -kOverlap, opening.top + kOverlap, materials.door);
    if (opening.top < wall.height) {
      side.box(along, 0.0, back, opening.top, top, materials.wall);
    }
    begin = along.end;
  }
  side.box({begin, wall.outer.end}, 0.0, back, -kOverlap, top, materials.wall);
}

/// The part of a wall within a span, with its openings and without glass.
Wall part_of(const Wall& wall, const Span& span) {
  Wall part = wall;
  part.outer = span;
  part.glass.clear();
  std::erase_if(part.openings, [&](const Opening& opening) {
    return opening.along.begin < span.begin || opening.along.end > span.end;
  });
  return part;
}

/// One wall of an arm, in two parts where it has a gap.
void add_arm_wall(const CorridorArm& arm, Side which, const Span& outer, const Materials& materials,
                  std::vector<Solid>& solids) {
  SideBuilder side(arm.T_world_arm, which, 0.5 * arm.width, solids);
  const bool left = which == Side::kLeft;
  const Wall whole{outer, arm.height, left ? arm.left : arm.right, arm.door_depth, {}};
  if (!left || !arm.left_gap) {
    add_wall(whole, materials, side);
    return;
  }
  add_wall(part_of(whole, {outer.begin, arm.left_gap->begin}), materials, side);
  add_wall(part_of(whole, {arm.left_gap->end, outer.end}), materials, side);
}

}  // namespace

Materials building_materials(const ReflectivityConfig& reflectivity) {
  return {.wall = {reflectivity.wall, {0.86F, 0.85F, 0.80F}},
          .ceiling = {reflectivity.ceiling, {0.93F, 0.93F, 0.92F}},
          .door = {reflectivity.door, {0.50F, 0.31F, 0.17F}},
          .pillar = {reflectivity.wall, {0.72F, 0.74F, 0.76F}},
          .clutter = {reflectivity.clutter, {0.25F, 0.42F, 0.56F}},
          .glass = {reflectivity.wall, {0.62F, 0.80F, 0.84F}}};
}

Pose line_at(double x, double y, double heading) {
  const Eigen::AngleAxisd turn(heading, Eigen::Vector3d::UnitZ());
  return {Eigen::Quaterniond(turn), Eigen::Vector3d(x, y, 0.0)};
}

Solid& SideBuilder::box(const Span& x, double near, double far, double bottom, double top,
                        const Material& material) {
  Solid solid;
  const Eigen::Vector3d centre(x.centre(), sign_ * (face_ + 0.5 * (near + far)),
                               0.5 * (bottom + top));
  solid.T_world_solid = T_world_line_ * Pose{Eigen::Quaterniond::Identity(), centre};
  solid.half_extents = {0.5 * (x.end - x.begin), 0.5 * (far - near), 0.5 * (top - bottom)};
  solid.material = material;
  solid.collides = false;
  return solids_.emplace_back(solid);
}

double wall_depth(const Wall& wall) {
  return wall.openings.empty() ? kWallThickness : wall.door_depth + kDoorThickness + kWallThickness;
}

void add_wall_slab(const Span& outer, double height, const Materials& materials,
                   SideBuilder& side) {
  Solid& slab = side.box(outer, 0.0, kWallThickness, 0.0, height, materials.wall);
  slab.collides = true;
  slab.visible = false;
}

void add_wall_faces(const Wall& wall, const Materials& materials, SideBuilder& side) {
  double begin = wall.outer.begin;
  for (const Span& pane : wall.glass) {
    if (pane.begin > begin) add_solid_faces(part_of(wall, {begin, pane.begin}), materials, side);
    side.box(pane, 0.0, kGlassThickness, -kOverlap, wall.height + kOverlap, materials.glass);
    begin = pane.end;
  }
  if (wall.outer.end > begin) {
    add_solid_faces(part_of(wall, {begin, wall.outer.end}), materials, side);
  }
}

void add_wall(const Wall& wall, const Materials& materials, SideBuilder& side) {
  add_wall_slab(wall.outer, wall.height, materials, side);
  add_wall_faces(wall, materials, side);
}

Solid cross_box(const Pose& T_world_line, const Span& x, double half_width, double bottom,
                double top, const Material& material) {
  Solid solid;
  const Eigen::Vector3d centre(x.centre(), 0.0, 0.5 * (bottom + top));
  solid.T_world_solid = T_world_line * Pose{Eigen::Quaterniond::Identity(), centre};
  solid.half_extents = {0.5 * (x.end - x.begin), half_width, 0.5 * (top - bottom)};
  solid.material = material;
  return solid;
}

double outer_half_width(double width, double door_depth) {
  return 0.5 * width + std::max(door_depth, 0.0) + kWallThickness + kDoorThickness;
}

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

std::vector<Span> door_openings(const DoorConfig& doors, const Span& along, Side side,
                                std::uint64_t seed, std::string_view stream) {
  RandomStream random = rng(seed, stream);
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

std::vector<Opening> openings_at(const std::vector<Span>& spans, double top) {
  std::vector<Opening> openings;
  for (const Span& span : spans) openings.push_back({span, top});
  return openings;
}

Result<void> validate_doors(const DoorConfig& doors, double wall_height, std::string_view key) {
  if (doors.sides == WallSides::kNone) return {};
  if (doors.width + 2.0 * doors.jitter >= doors.spacing) {
    return failure(
        fmt::format("{}.spacing: expected more than {} m (width and twice the jitter), got {}", key,
                    doors.width + 2.0 * doors.jitter, doors.spacing));
  }
  if (doors.height > wall_height) {
    return failure(fmt::format("{}.height: expected at most {} m (the corridor's height), got {}",
                               key, wall_height, doors.height));
  }
  return {};
}

void add_arm(const CorridorArm& arm, const Materials& materials, std::vector<Solid>& solids) {
  Span outer = arm.along;
  if (arm.begin_closed) outer.begin -= kWallThickness;
  if (arm.end_closed) outer.end += kWallThickness;
  for (const Side which : {Side::kLeft, Side::kRight}) {
    add_arm_wall(arm, which, outer, materials, solids);
  }
  const double half_width = outer_half_width(arm.width, arm.door_depth);
  const double top = arm.height + kOverlap;
  if (arm.begin_closed) {
    solids.push_back(cross_box(arm.T_world_arm, {outer.begin, arm.along.begin}, half_width,
                               -kOverlap, top, materials.wall));
  }
  if (arm.end_closed) {
    solids.push_back(cross_box(arm.T_world_arm, {arm.along.end, outer.end}, half_width, -kOverlap,
                               top, materials.wall));
  }
  // Over an open end the ceiling stops inside the wall that it opens through.
  Span covered = outer;
  if (!arm.begin_closed) covered.begin += 0.5 * kWallThickness;
  if (!arm.end_closed) covered.end -= 0.5 * kWallThickness;
  Solid ceiling = cross_box(arm.T_world_arm, covered, half_width, arm.height,
                            arm.height + kWallThickness, materials.ceiling);
  ceiling.collides = false;
  ceiling.roof = true;
  solids.push_back(ceiling);
}

namespace {

constexpr double kFrame = 0.1;          ///< of wall beside a door [m]
constexpr double kNarrowestPane = 0.1;  ///< [m]

/// Adds the part of a pane that remains beside a door, unless it is too narrow.
void add_rest(const Span& pane, std::vector<Span>& panes) {
  if (pane.length() >= kNarrowestPane) panes.push_back(pane);
}

}  // namespace

void describe(Fields& f, GlassConfig& c) {
  f.number("fraction", c.fraction,
           {.unit = "-",
            .range = in_range(0.0, 1.0),
            .meaning =
                "Fraction of the length of the walls that is glass, doors excluded; 0 for none."});
  f.number("pane_length", c.pane_length,
           {.unit = "m", .range = in_range(0.2, 50.0), .meaning = "Length of one pane."});
  f.number("max_incidence_deg", c.max_incidence_deg,
           {.unit = "deg",
            .range = in_range(0.0, 90.0),
            .meaning = "Largest angle of incidence at which a pane returns a beam; beams at larger "
                       "angles pass through."});
  f.number("reflectivity", c.reflectivity,
           {.unit = "-",
            .range = {.min = 0.0, .max = 1.0, .min_included = false},
            .meaning = "Diffuse reflectivity of a pane within that angle of incidence."});
  f.number(
      "backing_distance", c.backing_distance,
      {.unit = "m",
       .range = in_range(0.5, 20.0),
       .meaning = "Distance from the faces of the walls to the second walls behind the glass."});
}

Material glass_material(const GlassConfig& config) {
  // Never opaque: at 90 degrees the limit still is a positive cosine.
  const double cosine = std::max(std::cos(config.max_incidence_deg * kRadiansPerDegree), 1e-9);
  return {config.reflectivity, {0.62F, 0.80F, 0.84F}, cosine};
}

std::vector<Span> glass_panes(const GlassConfig& config, const Span& along,
                              const std::vector<Span>& doors) {
  std::vector<Span> panes;
  if (config.fraction <= 0.0) return panes;
  // Whole periods of pane and wall, so that the fraction holds for the whole wall.
  const double count =
      std::max(1.0, std::round(along.length() * config.fraction / config.pane_length));
  const double period = along.length() / count;
  for (int i = 0; i < static_cast<int>(count); ++i) {
    const double centre = along.begin + (i + 0.5) * period;
    Span rest{centre - 0.5 * config.fraction * period, centre + 0.5 * config.fraction * period};
    for (const Span& door : doors) {
      if (door.end + kFrame <= rest.begin || door.begin - kFrame >= rest.end) continue;
      add_rest({rest.begin, door.begin - kFrame}, panes);
      rest.begin = door.end + kFrame;
    }
    add_rest(rest, panes);
  }
  return panes;
}

}  // namespace aims
