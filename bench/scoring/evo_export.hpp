// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <string>

#include "bench/scoring/trajectory_scoring.hpp"
#include "core/error.hpp"

namespace aims {

/// The absolute errors of an estimate after the headline's alignment, as a result of evo that
/// evo_res reads: an archive with info.json, stats.json (rmse, mean, median, std, min, max, sse)
/// and error_array, timestamps, seconds_from_start and distances_from_start as .npy.
std::string evo_archive(const ScoredEstimate& estimate, const TrajectoryScores& scores);

/// Writes NAME.evo.zip of each estimate whose name can be one of a file.
Result<void> write_evo_archives(const TrajectoryScores& scores,
                                const std::filesystem::path& folder);

}  // namespace aims
