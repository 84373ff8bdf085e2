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

/// Sixteen rays spread evenly over the footprint of lane `lane`. Width is horizontal in the world.
RayPacket footprint_rays(const LidarBeamConfig& beam, const RayPacket& rays, int lane);

/// Half of the footprint's width at a distance, as an angle from the beam [rad].
double footprint_half_angle(const LidarBeamConfig& beam, double distance);

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
  EdgeMap(int rings, int columns);

  void clear();
  /// Marks `reach` firings of a ring on either side of the gap after column `before`.
  void mark(int ring, int before, int reach);
  void mark_one(int ring, int column) { marks_[index(ring, column)] = 1; }
  void unmark(int ring, int column) { marks_[index(ring, column)] = 0; }
  bool marked(int ring, int column) const { return marks_[index(ring, column)] != 0; }
  /// Whether any of the sixteen firings from `first` on is marked.
  bool any(int ring, int first) const;

 private:
  std::size_t index(int ring, int column) const {
    return static_cast<std::size_t>(ring) * stride_ + static_cast<std::size_t>(column);
  }

  int columns_;
  std::size_t stride_;
  std::vector<std::uint8_t> marks_;
};

}  // namespace aims
