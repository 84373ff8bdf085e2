// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "core/error.hpp"
#include "sim/environment/scene_config.hpp"
#include "sim/environment/wall.hpp"

namespace aims {

/// A straight piece of a corridor between two bends, along the x axis of its own frame, which
/// begins at the bend before.
struct CorridorPiece {
  Pose T_world_piece;
  Span along;                ///< of the centre line, from bend to bend or to the corridor's end
  double turn_before = 0.0;  ///< of the bend at the begin, positive to the left [rad]
  double turn_after = 0.0;   ///< of the bend at the end [rad]
};

/// Whether any bend has an angle.
bool has_bends(const CorridorConfig& config);

/// The pieces of a corridor in order; a single one when it has no bend. A bend beyond 90 degrees is
/// two of half the angle with a short piece between them.
std::vector<CorridorPiece> corridor_pieces(const CorridorConfig& config);

/// The face of one of a piece's walls, up to the mitre lines of its bends.
Span wall_face(const CorridorPiece& piece, Side side, double width);

/// The part of a piece in which both walls run and nothing reaches around a bend; may be empty.
Span straight_part(const CorridorPiece& piece, const CorridorConfig& config);

/// A one-way path along the centre line from the first point of the route to its last [m]. It cuts
/// bends by arcs of `kBendRadius`, in chords of at most 30 degrees.
std::vector<Eigen::Vector2d> centre_line(const CorridorConfig& config);
inline constexpr double kBendRadius = 1.0;  ///< [m]

/// Appends the arc of the bend at a piece's end, as `centre_line` has it.
void add_bend(const CorridorPiece& piece, std::vector<Eigen::Vector2d>& points);

/// Error for bends that leave no room between each other, meet, or go with what only a straight
/// corridor can have. A corridor without bends is right.
Result<void> validate_bends(const CorridorConfig& config);

/// Length of wall beyond an outer corner that fills the gap between two walls of that depth [m].
double corner_fill(double turn, double depth);

/// Corners of the ground that a piece covers with its walls [m].
std::array<Eigen::Vector2d, 4> outline(const CorridorPiece& piece, double half_width);

}  // namespace aims
