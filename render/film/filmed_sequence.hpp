// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "bench/estimate/progress.hpp"
#include "bench/scenario/scenario.hpp"
#include "core/error.hpp"
#include "core/trajectory.hpp"
#include "render/film/map_growth.hpp"
#include "render/plots/trajectory_plot.hpp"
#include "sim/environment/scene.hpp"
#include "sim/robot/robot_config.hpp"
#include "sim/robot/truth.hpp"

namespace aims {

/// What pictures of a sequence need, everything in the world frame.
struct FilmedSequence {
  std::string scenario;
  std::uint64_t seed = 0;
  bool complete = true;                     ///< false when the observer ended it early
  std::string robot = RobotConfig().model;  ///< of models/
  Scene scene;
  Trajectory truth;                      ///< T_world_body, at 10 Hz
  std::vector<RobotSnapshot> snapshots;  ///< at 10 Hz; none when the sequence comes from files
  std::vector<WaypointTime> waypoint_times;
  std::vector<NamedTrajectory> estimates;  ///< aligned at the start; the map is that of the first
  std::vector<GrownPoint> map;             ///< in order of time, without the returns of people
  std::vector<PlacedScan> scans;  ///< in order of time; none when the sequence comes from files
};

/// Simulates the scenario and runs its estimators; the first of them makes the map. Error when the
/// scenario cannot be simulated.
Result<FilmedSequence> film_sequence(const Scenario& scenario, const RunOptions& options,
                                     const Observer& observer);

/// Whether the folder is one that `aims run` writes for a seed.
bool holds_sequence(const std::filesystem::path& folder);

/// What the files of a run hold: trajectories, waypoint times, the scene (rebuilt from
/// config.yaml) and the final map of `mapped` (empty: of the first estimator that has one), whose
/// points all count as seen at the start. Joint angles are not in the files, so there is no
/// snapshot. The estimate that the map belongs to comes first. Error for a file that is missing or
/// broken.
Result<FilmedSequence> stored_sequence(const std::filesystem::path& folder,
                                       const std::string& mapped);

}  // namespace aims
