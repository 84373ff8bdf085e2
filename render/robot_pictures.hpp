// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "core/error.hpp"
#include "render/scene_view.hpp"
#include "sim/environment/scene.hpp"
#include "sim/truth.hpp"

namespace aims {

/// The camera beside, behind or ahead of the robot from which neither a solid nor the picture's
/// edge hides it: the first free one of a fixed list of view points, at most 25 degrees off the
/// robot's axis. `prefer_ahead`: views of its face come first.
Camera robot_camera(const Scene& scene, const std::vector<double>& qpos, bool prefer_ahead);

/// Snapshots near the start, in the middle of the way out, and at the turn (the farthest point
/// from the start, while the heading changes), in that order; fewer when there are not so many.
std::vector<std::size_t> notable_snapshots(const std::vector<RobotSnapshot>& snapshots);

/// Writes robot_start.png, robot_middle.png and robot_turn.png to `folder`: the robot in its scene,
/// with the scenario's name, time and place below. Returns the files written. Error when the scene
/// cannot be drawn, there is no snapshot, or a file cannot be written.
Result<std::vector<std::filesystem::path>> write_robot_pictures(
    const std::filesystem::path& folder, std::string_view scenario, const Scene& scene,
    std::string_view robot_mjcf, const std::vector<RobotSnapshot>& snapshots,
    const ViewConfig& config = {});

}  // namespace aims
