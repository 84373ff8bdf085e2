// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "core/error.hpp"
#include "recordings/bag/chunk_reader.hpp"
#include "recordings/trajectories/trajectory_file.hpp"

namespace aims {

/// Reads the poses of one topic of a recording: nav_msgs/Odometry, geometry_msgs/PoseStamped,
/// PoseWithCovarianceStamped or TransformStamped, the last nav_msgs/Path, the positions of a
/// geometry_msgs/PointStamped, or of tf (`tf_trajectory`). Stamps are those of
/// the headers, or record times when no header has one. Without `topic`: the only suitable one, or
/// the preferred one. Under strict rules, invalid poses and poses whose stamps do not increase are
/// dropped and counted in a note. Errors list the existing topics.
Result<TrajectoryFile> read_bag_trajectory(const std::filesystem::path& file,
                                           const std::string& topic,
                                           const TrajectoryFileOptions& options);

/// The text of the last std_msgs/String on `topic`; nothing when the bag has no such topic.
Result<std::optional<std::string>> read_bag_text(const std::filesystem::path& file,
                                                 const std::string& topic,
                                                 const BagOpenOptions& options = {});

}  // namespace aims
