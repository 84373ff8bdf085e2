// SPDX-License-Identifier: BSD-3-Clause
#include "sim/environment/corridor_pieces.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/angle.hpp"

namespace aims {
namespace {

constexpr double kLargestChord = 30.0 * kRadiansPerDegree;  ///< of a bend's arc [rad]
constexpr double kLeastStraight = 1.0;  ///< of a piece between what its bends take [m]
constexpr double kBeyondCorner = 0.05;  ///< by which a recess stays clear of a corner's walls [m]

double turn_of(const BendConfig& bend) {
  return (bend.side == Side::kLeft ? 1.0 : -1.0) * bend.angle_deg * kRadiansPerDegree;
}

/// Length of centre line that a bend takes to either side: of its mitre, or of the route's arc.
double reach(double turn, double width) {
  return std::max(0.5 * width, kBendRadius) * std::tan(0.5 * std::abs(turn));
}

/// Walls with a thickness cannot meet in one corner that is sharper than 90 degrees.
std::vector<BendConfig> bends_of(const CorridorConfig& config) {
  constexpr double kSharpest = 90.0;  ///< of one corner [deg]
  constexpr double kSlack = 0.01;     ///< [m]
  std::vector<BendConfig> bends;
  for (const BendConfig& bend : config.bends) {
    if (bend.angle_deg <= 0.0) continue;
    if (bend.angle_deg <= kSharpest) {
      bends.push_back(bend);
      continue;
    }
    BendConfig half = bend;
    half.angle_deg = 0.5 * bend.angle_deg;
    const double turn = std::abs(turn_of(half));
    // The piece after the bend must begin beyond the outline of the one before, walls included.
    const double outline = outer_half_width(config.width, config.doors.depth);
    const double clear =
        (outline * (1.0 - std::cos(2.0 * turn)) + kWallThickness * std::sin(2.0 * turn)) /
        std::sin(turn);
    const double room = 2.0 * reach(turn, config.width) + kLeastStraight;
    const double apart = 0.5 * std::max(clear, room) + kSlack;
    for (const double offset : {-apart, apart}) {
      half.at = bend.at + offset / config.length;
      bends.push_back(half);
    }
  }
  return bends;
}

/// A point of a piece's own axes in the world's plane.
Eigen::Vector2d place_on(const CorridorPiece& piece, double x, double y) {
  return (piece.T_world_piece * Eigen::Vector3d(x, y, 0.0)).head<2>();
}

/// Whether a direction along or across `a` separates the two rectangles.
bool separated_by_axis_of(const std::array<Eigen::Vector2d, 4>& a,
                          const std::array<Eigen::Vector2d, 4>& b) {
  for (const int corner : {0, 1}) {
    const Eigen::Vector2d axis = a[corner + 1] - a[corner];
    const auto extent = [&axis](const std::array<Eigen::Vector2d, 4>& corners) {
      Span span{axis.dot(corners[0]), axis.dot(corners[0])};
      for (const Eigen::Vector2d& each : corners) {
        span.begin = std::min(span.begin, axis.dot(each));
        span.end = std::max(span.end, axis.dot(each));
      }
      return span;
    };
    const Span first = extent(a);
    const Span second = extent(b);
    if (first.end <= second.begin || second.end <= first.begin) return true;
  }
  return false;
}

Result<void> check_pieces_apart(const std::vector<CorridorPiece>& pieces, double half_width) {
  for (std::size_t i = 0; i + 2 < pieces.size(); ++i) {
    for (std::size_t k = i + 2; k < pieces.size(); ++k) {
      const auto a = outline(pieces[i], half_width);
      const auto b = outline(pieces[k], half_width);
      if (separated_by_axis_of(a, b) || separated_by_axis_of(b, a)) continue;
      return failure(
          fmt::format("scene.corridor.bends: expected pieces of corridor that keep apart; the "
                      "pieces before bend {} and after bend {} meet",
                      i + 1, k));
    }
  }
  return {};
}

Result<void> check_only_straight(const CorridorConfig& config) {
  if (config.pillars.spacing > 0.0) {
    return failure("scene.corridor.pillars: expected none (spacing: 0) in a corridor with bends");
  }
  if (config.glass.fraction > 0.0) {
    return failure("scene.corridor.glass: expected none (fraction: 0) in a corridor with bends");
  }
  return {};
}

}  // namespace

double corner_fill(double turn, double depth) {
  return depth * std::tan(0.5 * std::abs(turn)) + kOverlap;
}

std::array<Eigen::Vector2d, 4> outline(const CorridorPiece& piece, double half_width) {
  const double begin = piece.along.begin - kWallThickness;
  const double end = piece.along.end + kWallThickness;
  return {place_on(piece, begin, -half_width), place_on(piece, end, -half_width),
          place_on(piece, end, half_width), place_on(piece, begin, half_width)};
}

bool has_bends(const CorridorConfig& config) { return !bends_of(config).empty(); }

std::vector<CorridorPiece> corridor_pieces(const CorridorConfig& config) {
  std::vector<CorridorPiece> pieces;
  CorridorPiece piece{{}, {-config.margin, 0.0}, 0.0, 0.0};
  double begin = 0.0;
  for (const BendConfig& bend : bends_of(config)) {
    const double at = bend.at * config.length;
    piece.along.end = at - begin;
    piece.turn_after = turn_of(bend);
    pieces.push_back(piece);
    const Pose bent{
        Eigen::Quaterniond(Eigen::AngleAxisd(piece.turn_after, Eigen::Vector3d::UnitZ())),
        Eigen::Vector3d(piece.along.end, 0.0, 0.0)};
    piece = {piece.T_world_piece * bent, {0.0, 0.0}, piece.turn_after, 0.0};
    begin = at;
  }
  piece.along.end = config.length - begin + config.margin;
  pieces.push_back(piece);
  return pieces;
}

Span wall_face(const CorridorPiece& piece, Side side, double width) {
  const double sign = side == Side::kLeft ? 0.5 * width : -0.5 * width;
  return {piece.along.begin + sign * std::tan(0.5 * piece.turn_before),
          piece.along.end - sign * std::tan(0.5 * piece.turn_after)};
}

Span straight_part(const CorridorPiece& piece, const CorridorConfig& config) {
  // A neighbour's wall reaches by its depth around an inner corner.
  const double depth = config.doors.depth + kDoorThickness + kWallThickness;
  const auto taken = [&](double turn) {
    if (turn == 0.0) return 0.0;
    return 0.5 * config.width * std::tan(0.5 * std::abs(turn)) + corner_fill(turn, depth) + depth +
           kBeyondCorner;
  };
  return {piece.along.begin + taken(piece.turn_before), piece.along.end - taken(piece.turn_after)};
}

void add_bend(const CorridorPiece& piece, std::vector<Eigen::Vector2d>& points) {
  const double turn = piece.turn_after;
  const double begin = piece.along.end - kBendRadius * std::tan(0.5 * std::abs(turn));
  const double side = turn > 0.0 ? kBendRadius : -kBendRadius;
  const double chords = std::ceil(std::abs(turn) / kLargestChord);
  for (double i = 0.0; i <= chords; i += 1.0) {
    const double angle = i / chords * std::abs(turn);
    points.push_back(
        place_on(piece, begin + kBendRadius * std::sin(angle), side * (1.0 - std::cos(angle))));
  }
}

std::vector<Eigen::Vector2d> centre_line(const CorridorConfig& config) {
  const std::vector<CorridorPiece> pieces = corridor_pieces(config);
  std::vector<Eigen::Vector2d> points = {Eigen::Vector2d::Zero()};
  for (const CorridorPiece& piece : pieces) {
    if (piece.turn_after == 0.0) {
      points.push_back(place_on(piece, piece.along.end - config.margin, 0.0));
      continue;
    }
    add_bend(piece, points);
  }
  return points;
}

Result<void> validate_bends(const CorridorConfig& config) {
  const std::vector<BendConfig> bends = bends_of(config);
  if (bends.empty()) return {};
  if (auto straight = check_only_straight(config); !straight) return straight;
  double begin = 0.0;
  double taken = 0.0;
  for (std::size_t i = 0; i <= bends.size(); ++i) {
    const bool last = i == bends.size();
    const double end = last ? config.length : bends[i].at * config.length;
    const double needed = last ? 0.0 : reach(turn_of(bends[i]), config.width);
    const double least = taken + needed + kLeastStraight;
    if (end - begin < least) {
      return failure(fmt::format(
          "scene.corridor.bends: expected at least {:.2f} m of route {} (in order), got {:.2f} m",
          least,
          i == 0 ? "before the first bend"
                 : (last ? std::string("after the last bend") : fmt::format("before bend {}", i)),
          end - begin));
    }
    begin = end;
    taken = needed;
  }
  return check_pieces_apart(corridor_pieces(config),
                            outer_half_width(config.width, config.doors.depth));
}

}  // namespace aims
