// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "bench/scoring/score_record.hpp"
#include "bench/scoring/trajectory_scoring.hpp"
#include "core/error.hpp"
#include "core/files/table.hpp"

namespace aims {

/// The table of scores (bench/scoring/score_table.hpp), a row per estimate.
TextTable trajectory_score_table(const TrajectoryScores& scores);

/// Where the truth and each estimate come from, and how they met.
TextTable trajectory_source_table(const TrajectoryScores& scores);

/// How the trajectories were aligned for each column, in words.
std::string score_legend(const TrajectoryScores& scores);

/// The record of schema aims.scores/2, with seed 0 and the truth's name as scenario.
RunRecord record_of(const TrajectoryScores& scores);

/// Writes scores.json, scores.csv and scores.md into `folder`.
Result<void> write_trajectory_scores(const TrajectoryScores& scores,
                                     const std::filesystem::path& folder);

}  // namespace aims
