// SPDX-License-Identifier: BSD-3-Clause
#include "sim/environment/bent_corridor.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "sim/environment/corridor.hpp"
#include "sim/environment/corridor_pieces.hpp"

namespace aims {
namespace {

/// One wall of a piece, filled up behind its outer corners.
void add_piece_wall(const CorridorPiece& piece, std::size_t index, Side which,
                    const CorridorConfig& config, const Materials& materials, std::uint64_t seed,
                    std::vector<Solid>& solids) {
  const char* name = which == Side::kLeft ? "left" : "right";
  const Span along = straight_part(piece, config);
  const auto doors = door_openings(config.doors, along, which, seed,
                                   fmt::format("scene.doors.{}.{}", name, index));
  const Span face = wall_face(piece, which, config.width);
  Wall wall{face, config.height, openings_at(doors, config.doors.height), config.doors.depth, {}};
  const double inwards = which == Side::kLeft ? 1.0 : -1.0;
  const double depth = wall_depth(wall);
  const auto beyond = [&](double turn) {
    if (turn == 0.0) return kWallThickness;
    return inwards * turn < 0.0 ? corner_fill(turn, depth) : 0.0;
  };
  wall.outer.begin -= beyond(piece.turn_before);
  wall.outer.end += beyond(piece.turn_after);
  SideBuilder side(piece.T_world_piece, which, 0.5 * config.width, solids);
  add_wall(wall, materials, side);
}

void add_piece_ceiling(const CorridorPiece& piece, const CorridorConfig& config,
                       const Materials& materials, std::vector<Solid>& solids) {
  const double half_width = outer_half_width(config.width, config.doors.depth);
  const auto beyond = [&](double turn) {
    return turn == 0.0 ? kWallThickness : corner_fill(turn, half_width);
  };
  const Span covered{piece.along.begin - beyond(piece.turn_before),
                     piece.along.end + beyond(piece.turn_after)};
  Solid ceiling = cross_box(piece.T_world_piece, covered, half_width, config.height,
                            config.height + kWallThickness, materials.ceiling);
  ceiling.collides = false;
  ceiling.roof = true;
  solids.push_back(ceiling);
}

void add_end_wall(const CorridorPiece& piece, const Span& x, const CorridorConfig& config,
                  const Materials& materials, std::vector<Solid>& solids) {
  solids.push_back(cross_box(piece.T_world_piece, x,
                             outer_half_width(config.width, config.doors.depth), -kOverlap,
                             config.height + kOverlap, materials.wall));
}

/// Objects at random places of the pieces' straight parts.
void add_piece_clutter(const std::vector<CorridorPiece>& pieces, const CorridorConfig& config,
                       const Material& material, std::uint64_t seed, std::vector<Solid>& solids) {
  RandomStream random = rng(seed, "scene.clutter");
  double length = 0.0;
  for (const CorridorPiece& piece : pieces) {
    length += std::max(0.0, straight_part(piece, config).length());
  }
  const auto count = std::lround(config.clutter.density * length);
  for (long i = 0; i < count; ++i) {
    double along = random.uniform(0.0, length);
    for (const CorridorPiece& piece : pieces) {
      const Span part = straight_part(piece, config);
      if (part.length() <= 0.0) continue;
      if (along > part.length()) {
        along -= part.length();
        continue;
      }
      Solid object = clutter_object(config, part.begin + along, material, random);
      object.T_world_solid = piece.T_world_piece * object.T_world_solid;
      solids.push_back(object);
      break;
    }
  }
}

}  // namespace

void add_pieces(const std::vector<CorridorPiece>& pieces, const CorridorConfig& config,
                const Materials& materials, std::uint64_t seed, std::vector<Solid>& solids) {
  for (std::size_t i = 0; i < pieces.size(); ++i) {
    add_piece_wall(pieces[i], i, Side::kLeft, config, materials, seed, solids);
    add_piece_wall(pieces[i], i, Side::kRight, config, materials, seed, solids);
    add_piece_ceiling(pieces[i], config, materials, solids);
  }
}

std::vector<Solid> bent_corridor_solids(const CorridorConfig& config, const Materials& materials,
                                        std::uint64_t seed) {
  const std::vector<CorridorPiece> pieces = corridor_pieces(config);
  std::vector<Solid> solids;
  add_pieces(pieces, config, materials, seed, solids);
  const Span first = pieces.front().along;
  const Span last = pieces.back().along;
  if (has_end(config, EndWalls::kStart)) {
    add_end_wall(pieces.front(), {first.begin - kWallThickness, first.begin}, config, materials,
                 solids);
  }
  if (has_end(config, EndWalls::kEnd)) {
    add_end_wall(pieces.back(), {last.end, last.end + kWallThickness}, config, materials, solids);
  }
  add_piece_clutter(pieces, config, materials.clutter, seed, solids);
  return solids;
}

Span walked_part(const CorridorPiece& piece, double width) {
  const auto clear = [width](double turn) {
    return turn == 0.0 ? 1.0 : 0.5 * width * std::tan(0.5 * std::abs(turn)) + 0.5;
  };
  return {piece.along.begin + clear(piece.turn_before), piece.along.end - clear(piece.turn_after)};
}

Floor floor_under(const std::vector<CorridorPiece>& pieces, const CorridorConfig& config) {
  Floor floor;
  floor.min_corner = Eigen::Vector2d::Constant(1e12);
  floor.max_corner = -floor.min_corner;
  for (const CorridorPiece& piece : pieces) {
    for (const auto& corner : outline(piece, outer_half_width(config.width, config.doors.depth))) {
      floor.min_corner = floor.min_corner.cwiseMin(corner);
      floor.max_corner = floor.max_corner.cwiseMax(corner);
    }
  }
  return floor;
}

}  // namespace aims
