// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <span>
#include <string>

#include "bench/run/evaluate.hpp"
#include "core/error.hpp"
#include "core/trajectory.hpp"

namespace aims {

/// Draws NAME-map-top.png and NAME-map-side.png; nothing for an estimator without a map.
Result<void> draw_map(const std::string& title, const EstimatorOutcome& outcome,
                      const std::filesystem::path& folder);

/// Series that `draw_degeneracy` uses.
std::vector<std::string> drawn_series();

/// Draws degeneracy.png: the index and what follows from it over time; nothing, and false, for an
/// estimator that reports none of the series. A series that is missing leaves its curve out.
/// `waypoint_times` are marked.
Result<bool> draw_degeneracy(const std::string& title, const std::string& subtitle,
                             const EstimatorOutcome& outcome,
                             std::span<const WaypointTime> waypoint_times,
                             const std::filesystem::path& folder);

}  // namespace aims
