// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/lie.hpp"
#include "core/time.hpp"

namespace aims {

/// Pose of the body in a fixed frame at an instant.
struct StampedPose {
  Time stamp = 0;
  Pose pose;
};

/// Poses with strictly increasing stamps.
using Trajectory = std::vector<StampedPose>;

/// True time at which the robot passed a named waypoint.
struct WaypointTime {
  std::string point;
  Time stamp = 0;
};

/// Pose at `stamp`, interpolated between neighbours; empty outside the trajectory's span.
std::optional<Pose> pose_at(const Trajectory& trajectory, Time stamp);

/// The first pose, then each pose at least `spacing` after the last one kept.
Trajectory thinned(const Trajectory& trajectory, Duration spacing);

}  // namespace aims
