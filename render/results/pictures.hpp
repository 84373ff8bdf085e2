// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "bench/estimate/estimate.hpp"
#include "bench/estimate/progress.hpp"
#include "bench/scoring/trajectory_scoring.hpp"
#include "core/error.hpp"

namespace aims {

/// Draws a run into its folder (bench/studies/written_runs.hpp): the robot along the route, each
/// estimator's map from above and from the side, every trajectory over the plan, and the degeneracy
/// index over time; on two threads when `threads` is more than one.
Result<void> draw_run(const std::filesystem::path& folder, const DrawObserver& observer = {},
                      int threads = 1);

/// Draws the run in `folder` as the paper does: NAME-trajectories.png with every estimator, and
/// NAME-maps.png with the maps of those estimators of `maps` that ran, side by side. NAME is the
/// scenario's; both lie in `out`.
Result<void> draw_systems(const std::filesystem::path& folder, const std::vector<std::string>& maps,
                          const std::filesystem::path& out, const DrawObserver& observer = {});

/// The pictures in `folder` and below, by name.
std::vector<std::filesystem::path> pictures_in(const std::filesystem::path& folder);

/// Draws the maps and the degeneracy index; with a truth also the trajectories.
Result<void> draw_estimate(const EstimateResult& result, const std::filesystem::path& folder,
                           const DrawObserver& observer = {});

/// Draws trajectories.png (plan, height and error along the way) and errors.png (position, height
/// and heading error over time) into `folder`.
Result<void> draw_trajectory_pictures(const TrajectoryScores& scores,
                                      const std::filesystem::path& folder,
                                      const DrawObserver& observer = {});

}  // namespace aims
