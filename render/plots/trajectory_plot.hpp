// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "core/error.hpp"
#include "core/trajectory.hpp"
#include "sim/environment/scene.hpp"

namespace aims {

struct NamedTrajectory {
  std::string name;
  Trajectory trajectory;
};

/// What the picture of all trajectories shows. All are given in the world frame, aligned by the
/// caller; the reference points come from where the truth was at the waypoint_times.
struct TrajectoryPlot {
  std::string title;
  std::string subtitle;
  Scene scene;  ///< its walls are drawn as a plan
  Trajectory truth;
  std::vector<NamedTrajectory> estimates;
  std::vector<WaypointTime> waypoint_times;
};

/// Writes three panels: the plan with all trajectories, height, and position error (logarithmic)
/// over the distance travelled. The axes follow the truth and what stays near it: a
/// trajectory that leaves them is cut and named so in the legend. Error without a truth or when
/// the file (.png, .svg, .pdf) cannot be written.
Result<void> write_trajectory_plot(const std::filesystem::path& path, const TrajectoryPlot& plot);

}  // namespace aims
