// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <string>

#include "core/error.hpp"
#include "recordings/trajectories/trajectory_file.hpp"

namespace aims {

/// Whether the topic of a source is that of transforms: "/tf", or "/tf:PARENT,CHILD".
bool names_transforms(const std::string& topic);

/// The poses of frame CHILD in frame PARENT, over any chain of transforms of `topic` and
/// /tf_static: one for each transform of the fastest link, the others interpolated. Without frames
/// the only pair that changes is taken. Errors list the frames that exist.
Result<TrajectoryFile> read_tf_trajectory(const std::filesystem::path& file,
                                          const std::string& topic,
                                          const TrajectoryFileOptions& options);

}  // namespace aims
