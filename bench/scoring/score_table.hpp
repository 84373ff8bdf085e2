// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <span>
#include <string>
#include <vector>

#include "bench/metrics/scores.hpp"
#include "bench/scoring/score_record.hpp"
#include "core/files/table.hpp"

namespace aims {

/// The table of scores of all commands, over one or more runs: a row per estimator; over several
/// runs each cell is "median (worst)", and success the fraction of runs with its interval. Of
/// several estimators, the best figure of each column among those with a success carries a star; a
/// median over runs without success is marked "x", an ATE SE(3) where evo gives none "line" or
/// "point". An estimator that failed on some runs, or on all, is said to have. A re-optimized
/// trajectory has a row of its own, "NAME (optimized)". Invalid runs are left out; without a valid
/// one there are no scores.
TextTable score_table(std::span<const RunRecord> runs);

/// How the trajectories were aligned for each column, and what the marks mean that stand in the
/// table.
std::string score_legend(std::span<const RunRecord> runs, const ScoreConfig& scoring);

/// The same of the tables of several scenarios.
std::string legend_of_tables(const std::vector<std::span<const RunRecord>>& tables,
                             const ScoreConfig& scoring);

}  // namespace aims
