// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <optional>
#include <string_view>
#include <vector>

#include "core/config.hpp"
#include "core/error.hpp"
#include "sim/environment/building_config.hpp"
#include "sim/environment/scene.hpp"

namespace aims {

inline constexpr double kWallThickness = 0.2;  ///< of plain and end walls [m]
inline constexpr double kOverlap = 0.05;  ///< of pieces behind visible faces, against leaks [m]
inline constexpr double kGlassThickness = 0.01;  ///< [m]
inline constexpr double kDoorThickness = 0.05;   ///< [m]

/// An interval along a wall [m].
struct Span {
  double begin = 0.0;
  double end = 0.0;
  double centre() const { return 0.5 * (begin + end); }
  double length() const { return end - begin; }
};

/// Materials of the parts of a building.
struct Materials {
  Material wall, ceiling, door, pillar, clutter, glass;
};
Materials building_materials(const ReflectivityConfig& reflectivity);

/// Frame in the plane z = 0 with its origin at (x, y) [m] and its x axis at `heading` [rad].
Pose line_at(double x, double y, double heading);

/// Adds boxes on one side of a line, given by their distances behind a face parallel to it.
class SideBuilder {
 public:
  /// The face is `face` [m] from the line, which is the x axis of `T_world_line`.
  SideBuilder(const Pose& T_world_line, Side side, double face, std::vector<Solid>& solids)
      : T_world_line_(T_world_line),
        sign_(side == Side::kLeft ? 1.0 : -1.0),
        face_(face),
        solids_(solids) {}

  /// A box along `x`, from `near` to `far` behind the face, between two heights; it is visible
  /// but does not collide.
  Solid& box(const Span& x, double near, double far, double bottom, double top,
             const Material& material);

 private:
  Pose T_world_line_;
  double sign_;
  double face_;
  std::vector<Solid>& solids_;
};

/// An opening in a wall with a door set back into it.
struct Opening {
  Span along;
  double top = 2.05;  ///< height of the lintel [m]
};

/// A straight wall with doors set back into it and panes of glass in it.
struct Wall {
  Span outer;                     ///< of the wall, ends included
  double height = 2.6;            ///< [m]
  std::vector<Opening> openings;  ///< in order
  double door_depth = 0.15;       ///< of the doors' faces behind the wall's [m]
  std::vector<Span> glass;        ///< in order, clear of the openings
};

/// Thickness of a wall with its doors [m].
double wall_depth(const Wall& wall);

/// The invisible colliding slab and the visible pieces.
void add_wall(const Wall& wall, const Materials& materials, SideBuilder& side);

/// The visible pieces alone.
void add_wall_faces(const Wall& wall, const Materials& materials, SideBuilder& side);

/// The colliding slab alone.
void add_wall_slab(const Span& outer, double height, const Materials& materials, SideBuilder& side);

/// A box across a line, from `x.begin` to `x.end` along it and `half_width` [m] to either side.
Solid cross_box(const Pose& T_world_line, const Span& x, double half_width, double bottom,
                double top, const Material& material);

/// Half width [m] of end walls and ceiling, which cover the thickness of the walls.
double outer_half_width(double width, double door_depth);

/// Whether the feature number `index` along a wall is on that side.
bool on_side(WallSides sides, Side side, int index);

/// Openings of the doors in one wall, in order, clear of the ends of `along`. Draws from `stream`.
std::vector<Span> door_openings(const DoorConfig& doors, const Span& along, Side side,
                                std::uint64_t seed, std::string_view stream);

/// Openings over the spans, lintels `top` [m] high.
std::vector<Opening> openings_at(const std::vector<Span>& spans, double top);

/// Error for doors that do not fit; `key` names their group in the configuration.
Result<void> validate_doors(const DoorConfig& doors, double wall_height, std::string_view key);

/// A straight corridor along the x axis of its own frame.
struct CorridorArm {
  Pose T_world_arm;
  Span along;
  double width = 2.2;   ///< [m]
  double height = 2.6;  ///< [m]
  bool begin_closed = false;
  bool end_closed = false;
  std::vector<Opening> left;
  std::vector<Opening> right;
  double door_depth = 0.15;      ///< [m]
  std::optional<Span> left_gap;  ///< where another corridor of that height begins
};

/// Walls, end walls and ceiling. An open end must lie in a wall at least `kWallThickness` thick.
void add_arm(const CorridorArm& arm, const Materials& materials, std::vector<Solid>& solids);

/// Panes of glass in a corridor's walls. A pane returns beams near normal incidence; all others
/// pass through, both ways, and hit the wall behind it.
struct GlassConfig {
  double fraction = 0.0;            ///< of the length of the walls that is glass [-]; 0: none
  double pane_length = 2.0;         ///< [m]
  double max_incidence_deg = 10.0;  ///< largest angle of incidence that returns a beam [deg]
  double reflectivity = 0.5;        ///< diffuse, within that angle [-]
  double backing_distance = 1.0;    ///< from the walls to the second walls behind them [m]
};

void describe(Fields& fields, GlassConfig& config);

/// The material of the panes.
Material glass_material(const GlassConfig& config);

/// The panes in a wall, in order: regularly spaced over `along`, cut off at the doors' frames.
std::vector<Span> glass_panes(const GlassConfig& config, const Span& along,
                              const std::vector<Span>& doors);

}  // namespace aims
