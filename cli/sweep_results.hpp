// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>

#include "bench/scoring/json_text.hpp"
#include "bench/tuning/objective.hpp"
#include "bench/tuning/sweep_store.hpp"
#include "core/error.hpp"

namespace aims {

/// Writes sweep.sqlite, sweep.csv and, of a sweep with ranges, sweep.md into `out`, which is made.
Result<void> write_results(const MergedSweep& sweep, const Objective& objective,
                           const std::filesystem::path& out);

/// Prints every point that is complete with its objective and score, up to a number, and what the
/// objective is; nothing without ranges.
void print_points(const MergedSweep& sweep, const Objective& objective);

/// Every complete point per estimator, as `response_json`; null without ranges.
Json points_json(const MergedSweep& sweep, const Objective& objective);

}  // namespace aims
