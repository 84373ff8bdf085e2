// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <vector>

#include "sim/sensors/lidar_config.hpp"
#include "sim/sensors/return_model.hpp"

namespace aims {

/// Whether a step in range lies between two beams: one sees a surface that ends in front of the
/// other's. The planes of both hits tell it from a corner, where they meet.
bool range_steps_between(const RayPacket& rays_a, const HitPacket& hits_a, int a,
                         const RayPacket& rays_b, const HitPacket& hits_b, int b);

/// Rays within the footprint of a beam. Its width is horizontal in the world.
class BeamFootprint {
 public:
  explicit BeamFootprint(const LidarBeamConfig& beam);

  /// Sixteen rays spread evenly over the footprint of lane `lane`.
  RayPacket parts(const RayPacket& rays, int lane) const;

  /// The ray in the middle of the footprint's upper (+1) or lower (-1) edge, for every lane.
  RayPacket border(const RayPacket& rays, int side) const;

  /// Half of the footprint's width at a distance, as an angle from the beam [rad].
  double half_angle(double distance) const;

 private:
  LidarBeamConfig beam_;
  LaneValues shift_across_, shift_up_;  ///< of the origin, by part [m]
  LaneValues turn_across_, turn_up_;    ///< of the direction, by part [rad]
  LaneValues scale_;                    ///< makes the direction a unit vector
};

/// What the receiver takes from a footprint of sixteen equal parts.
struct Echo {
  float distance = 0.0F;  ///< mean over the echo, weighted by power [m]
  float strength = 0.0F;  ///< of a perpendicular surface at that distance that fills the footprint
  int lane = -1;          ///< of the most powerful part of the echo; -1: no return
};

/// The strongest echo: hits nearer to each other in range than `pulse_length` [m] are one.
Echo strongest_echo(const HitPacket& hits, const LaneValues& strength, double pulse_length);

/// The firings of a scan whose footprint may meet a step in range.
class EdgeMap {
 public:
  /// Where the step may be, as bits.
  enum Place : std::uint8_t { kNone = 0, kBeside = 1, kAbove = 2, kBelow = 4 };

  EdgeMap(int rings, int columns);

  void clear();
  /// Marks `reach` firings of a ring on either side of the gap after column `before`.
  void mark_beside(int ring, int before, int reach);
  void mark(int ring, int column, Place place) { marks_[index(ring, column)] |= place; }
  void unmark(int ring, int column, Place place) {
    marks_[index(ring, column)] &= static_cast<std::uint8_t>(~place);
  }
  void unmark(int ring, int column) { marks_[index(ring, column)] = kNone; }
  bool marked(int ring, int column) const { return marks_[index(ring, column)] != kNone; }
  bool marked(int ring, int column, Place place) const {
    return (marks_[index(ring, column)] & place) != 0;
  }
  /// Whether any of the sixteen firings from `first` on is marked at one of `places`.
  bool any(int ring, int first, int places) const;

 private:
  std::size_t index(int ring, int column) const {
    return static_cast<std::size_t>(ring) * stride_ + static_cast<std::size_t>(column);
  }

  int columns_;
  std::size_t stride_;
  std::vector<std::uint8_t> marks_;
};

}  // namespace aims
