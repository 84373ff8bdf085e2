// SPDX-License-Identifier: BSD-3-Clause
#include "sim/environment/tunnel.hpp"

#include <fmt/format.h>

#include <cmath>
#include <numbers>

#include "sim/environment/wall.hpp"

namespace aims {
namespace {

constexpr double kFacet = 0.25;    ///< longest visible facet, along the centre line [m]
constexpr double kJamb = 0.1;      ///< of flat wall beside a door [m]
constexpr int kSlabsPerSide = 20;  ///< each collides, which costs physics time

/// Distance of a wall's circle from the arc's centre, less the radius of the centre line.
double offset_of(const TunnelConfig& c, Side side) {
  return side == Side::kLeft ? -0.5 * c.width : 0.5 * c.width;
}

/// The point at arc length `s` of the centre line, moved outwards by `offset` [m].
Eigen::Vector2d point_at(const TunnelConfig& c, double s, double offset) {
  const double angle = s / c.radius;
  const double r = c.radius + offset;
  return {r * std::sin(angle), c.radius - r * std::cos(angle)};
}

/// A chord of one wall's circle: its frame at the begin, and its length.
struct Chord {
  Pose T_world_chord;
  double length;
};

Chord chord_of(const TunnelConfig& c, Side side, const Span& along) {
  const Eigen::Vector2d begin = point_at(c, along.begin, offset_of(c, side));
  const Eigen::Vector2d step = point_at(c, along.end, offset_of(c, side)) - begin;
  return {line_at(begin.x(), begin.y(), std::atan2(step.y(), step.x())), step.norm()};
}

/// Slack at a facet's ends: outer facets diverge behind their faces, inner ones overlap anyway.
double slack(Side side) { return side == Side::kRight ? kOverlap : 0.0; }

/// The wall between two doors, as equal facets.
void add_facets(const TunnelConfig& c, Side which, const Span& along, const Materials& materials,
                std::vector<Solid>& solids) {
  const int count = std::max(1, static_cast<int>(std::ceil(along.length() / kFacet)));
  for (int i = 0; i < count; ++i) {
    const Chord chord = chord_of(
        c, which,
        {along.begin + along.length() * i / count, along.begin + along.length() * (i + 1) / count});
    SideBuilder side(chord.T_world_chord, which, 0.0, solids);
    add_wall_faces({{-slack(which), chord.length + slack(which)}, c.height, {}, 0.0, {}}, materials,
                   side);
  }
}

/// One flat facet with a door in its middle.
void add_door(const TunnelConfig& c, Side which, const Span& along, const Materials& materials,
              std::vector<Solid>& solids) {
  const Chord chord = chord_of(c, which, along);
  const double middle = 0.5 * chord.length;
  const Span opening{middle - 0.5 * c.doors.width, middle + 0.5 * c.doors.width};
  SideBuilder side(chord.T_world_chord, which, 0.0, solids);
  add_wall_faces({{-slack(which), chord.length + slack(which)},
                  c.height,
                  {{opening, c.doors.height}},
                  c.doors.depth,
                  {}},
                 materials, side);
}

/// The tunnel along its centre line, between the faces of the end walls.
Span extent(const TunnelConfig& c) { return {-c.margin, c.length + c.margin}; }

void add_side(const TunnelConfig& c, Side which, std::uint64_t seed, const Materials& materials,
              std::vector<Solid>& solids) {
  const Span along = extent(c);
  const char* stream =
      which == Side::kLeft ? "scene.tunnel.doors.left" : "scene.tunnel.doors.right";
  const Span outer{along.begin - 0.5 * kWallThickness, along.end + 0.5 * kWallThickness};
  for (int i = 0; i < kSlabsPerSide; ++i) {
    const Chord chord = chord_of(c, which,
                                 {outer.begin + outer.length() * i / kSlabsPerSide,
                                  outer.begin + outer.length() * (i + 1) / kSlabsPerSide});
    SideBuilder side(chord.T_world_chord, which, 0.0, solids);
    add_wall_slab({0.0, chord.length}, c.height, materials, side);
  }
  // The flat piece around a door spans the jambs at the wall's own radius.
  const double scale = c.radius / (c.radius + offset_of(c, which));
  const double half = (0.5 * c.doors.width + kJamb) * scale;
  double begin = outer.begin;
  for (const Span& opening : door_openings(c.doors, along, which, seed, stream)) {
    const Span flat{opening.centre() - half, opening.centre() + half};
    add_facets(c, which, {begin, flat.begin}, materials, solids);
    add_door(c, which, flat, materials, solids);
    begin = flat.end;
  }
  add_facets(c, which, {begin, outer.end}, materials, solids);
}

/// Smallest rectangle around the tunnel's centre line, `beyond` [m] larger on every side.
Floor rectangle(const TunnelConfig& c, double beyond) {
  constexpr int kSteps = 400;
  const Span along = extent(c);
  Floor floor;
  floor.min_corner.setConstant(1e9);
  floor.max_corner.setConstant(-1e9);
  for (int i = 0; i <= kSteps; ++i) {
    const Eigen::Vector2d point = point_at(c, along.begin + along.length() * i / kSteps, 0.0);
    floor.min_corner = floor.min_corner.cwiseMin(point);
    floor.max_corner = floor.max_corner.cwiseMax(point);
  }
  floor.min_corner.array() -= beyond;
  floor.max_corner.array() += beyond;
  return floor;
}

void add_ends_and_ceiling(const TunnelConfig& c, const Materials& materials,
                          std::vector<Solid>& solids) {
  const Span along = extent(c);
  const double half_width = outer_half_width(c.width, c.doors.depth);
  const auto add_end = [&](double s, const Span& x) {
    const Eigen::Vector2d point = point_at(c, s, 0.0);
    solids.push_back(cross_box(line_at(point.x(), point.y(), s / c.radius), x, half_width,
                               -kOverlap, c.height + kOverlap, materials.wall));
  };
  add_end(along.begin, {-kWallThickness, 0.0});
  add_end(along.end, {0.0, kWallThickness});
  const Floor cover = rectangle(c, half_width + kWallThickness);
  const Eigen::Vector2d middle = 0.5 * (cover.min_corner + cover.max_corner);
  const Eigen::Vector2d half = 0.5 * (cover.max_corner - cover.min_corner);
  Solid ceiling = cross_box(line_at(middle.x(), middle.y(), 0.0), {-half.x(), half.x()}, half.y(),
                            c.height, c.height + kWallThickness, materials.ceiling);
  ceiling.collides = false;
  ceiling.roof = true;
  solids.push_back(ceiling);
}

}  // namespace

void describe(Fields& f, TunnelConfig& c) {
  f.number("radius", c.radius,
           {.unit = "m", .range = in_range(5.0, 1e4), .meaning = "Radius of the centre line."});
  f.number("length", c.length,
           {.unit = "m",
            .range = in_range(1.0, 500.0),
            .meaning = "Length of the route along the arc."});
  f.number("margin", c.margin,
           {.unit = "m",
            .range = in_range(1.0, 100.0),
            .meaning = "Length of tunnel beyond either end of the route."});
  f.number("width", c.width,
           {.unit = "m",
            .range = in_range(1.0, 6.0),
            .meaning = "Width of the tunnel between its walls."});
  f.number("height", c.height,
           {.unit = "m",
            .range = in_range(1.0, 20.0),
            .meaning = "Height of the tunnel from floor to ceiling."});
  f.group("doors", c.doors);
}

Result<void> validate(const TunnelConfig& config) {
  const double max_length = 2.0 * std::numbers::pi * config.radius - 2.0 * config.width - 2.0;
  const double total = config.length + 2.0 * config.margin;
  if (total > max_length) {
    return failure(fmt::format(
        "scene.tunnel.length: expected at most {:.1f} m with both margins (one turn of the arc), "
        "got {}",
        max_length, total));
  }
  return validate_doors(config.doors, config.height, "scene.tunnel.doors");
}

std::vector<Solid> tunnel_solids(const TunnelConfig& config, const ReflectivityConfig& reflectivity,
                                 std::uint64_t seed) {
  const Materials materials = building_materials(reflectivity);
  std::vector<Solid> solids;
  for (const Side side : {Side::kLeft, Side::kRight}) {
    add_side(config, side, seed, materials, solids);
  }
  add_ends_and_ceiling(config, materials, solids);
  return solids;
}

Floor tunnel_floor(const TunnelConfig& config) {
  return rectangle(config, outer_half_width(config.width, config.doors.depth) + 0.5);
}

}  // namespace aims
