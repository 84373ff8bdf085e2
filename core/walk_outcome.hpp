// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string_view>

namespace aims {

/// How a simulated walk ended.
enum class WalkEnd {
  kRunning,          ///< it has not: the walk goes on, or whoever simulated it has stopped
  kRouteDone,        ///< at its last point, after the last standing time
  kFell,             ///< the trunk is on the floor, or tilted beyond recovery
  kLeftScene,        ///< the robot is beyond the floor's border, or below the floor
  kNoProgress,       ///< it came no nearer to its next point for too long
  kTimeLimit,        ///< max_duration
  kUnstablePhysics,  ///< the integrator gave up a step and reset the robot
};

/// "running", "route_done", "fell", "left_scene", "no_progress", "time_limit", "unstable_physics".
constexpr std::string_view name_of(WalkEnd end) {
  constexpr std::string_view kNames[] = {"running",         "route_done",  "fell",
                                         "left_scene",      "no_progress", "time_limit",
                                         "unstable_physics"};
  return kNames[static_cast<int>(end)];
}

/// What became of a walk, whatever its sensors delivered.
struct WalkOutcome {
  WalkEnd end = WalkEnd::kRunning;  ///< the last sample of the truth has its time
  bool touched_wall = false;        ///< at any time, standing included
  /// Time in contact with walls over the time under way, in [0, 1]; 0 while it has not set off.
  /// Under way: the robot turns, walks or comes to rest for a point; standing times do not count.
  /// In contact: a part has touched a solid other than the floor within the last stride, because a
  /// robot that trots along a wall touches it once per stride and not at each physics step.
  double wall_contact_fraction = 0.0;
};

}  // namespace aims
