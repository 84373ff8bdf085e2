// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <string>

#include "bench/run/outcome.hpp"
#include "core/error.hpp"

namespace aims {

/// Ending of the file of a re-optimized trajectory.
inline constexpr const char* kOptimizedEnding = ".optimized.tum";

/// Writes what one estimator came to: NAME.tum, where it has them the re-optimized trajectory
/// (NAME.optimized.tum) and its map (NAME.map.ply), NAME.diagnostics.csv and NAME.health.csv, in
/// this order.
Result<void> write_estimator(const EstimatorOutcome& outcome, const std::filesystem::path& folder,
                             const std::string& name);

/// Reads those files but for the health; the outcome has no scores.
Result<EstimatorOutcome> read_estimator(const std::filesystem::path& folder,
                                        const std::string& name);

/// Endings of those files, with their dots.
inline constexpr const char* kEstimatorFiles[] = {".tum", kOptimizedEnding, ".map.ply",
                                                  ".diagnostics.csv", ".health.csv"};

}  // namespace aims
