// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "core/error.hpp"
#include "render/scene/scene_view.hpp"
#include "sim/environment/scene.hpp"
#include "sim/robot/truth.hpp"

namespace aims {

/// Camera that looks at the robot roughly along `heading` [rad] (0: along +x), or opposite to it,
/// turned by at most 25 degrees: the first of a fixed list of view points that no solid hides.
Camera robot_camera(const Scene& scene, const std::vector<double>& qpos, double heading);

/// Snapshots near the start, in the middle of the outbound leg, and at the turn (the farthest point
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
