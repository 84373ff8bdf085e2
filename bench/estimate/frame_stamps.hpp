// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "core/error.hpp"
#include "core/trajectory.hpp"
#include "recordings/trajectories/trajectory_file.hpp"

namespace aims {

/// Gives poses whose stamps are numbers of frames (`is_frame_index`) the stamps of those frames,
/// and notes it; others stay as they are. Numbers count from 0, or from 1 where the last is that of
/// the last frame. Error for a frame without a stamp.
Result<void> stamp_frames(const StampList& times, const std::string& name, Trajectory& poses,
                          std::vector<std::string>& notes);

}  // namespace aims
