// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "core/error.hpp"
#include "core/trajectory.hpp"

namespace aims {

/// What a simulated bag holds of its own origin, for scoring; nothing of it reaches an estimator.
struct BagOrigin {
  std::vector<WaypointTime> waypoint_times;  ///< of the reference points, in order of time
  std::vector<std::string> segments;         ///< over which its scenario takes M_list; empty: all
};

/// Empty for a bag that was not simulated here; `with`: further files of the same recording. Error
/// for waypoint times that cannot be read.
Result<BagOrigin> bag_origin(const std::filesystem::path& bag,
                             const std::vector<std::filesystem::path>& with = {});

/// Over which segments the scenario takes M_list whose run wrote this file of waypoint times, and
/// the file that says so; neither when nothing beside it does.
struct StatedSegments {
  std::vector<std::string> names;
  std::filesystem::path source;
};

/// As stated by `config.yaml` beside `waypoint_times.csv` of a run, or by NAME.bag beside
/// NAME.waypoint_times.csv.
StatedSegments segments_beside(const std::filesystem::path& waypoint_times);

}  // namespace aims
