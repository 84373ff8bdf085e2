// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>

#include "bench/run/draw_observer.hpp"
#include "bench/scoring/trajectory_scoring.hpp"
#include "core/error.hpp"

namespace aims {

/// Draws trajectories.png (plan, height and error along the way) and errors.png (position, height
/// and heading error over time) into `folder`.
Result<void> draw_trajectory_pictures(const TrajectoryScores& scores,
                                      const std::filesystem::path& folder,
                                      const DrawObserver& observer = {});

}  // namespace aims
