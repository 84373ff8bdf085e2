// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <span>
#include <string>

#include "bench/run/score_record.hpp"
#include "core/files/table.hpp"

namespace aims {

/// The headline scores and the paper's Table I over one or more runs: a row per estimator; over
/// several runs each cell is "median (worst)", and success the fraction of runs with its interval.
/// A re-optimized trajectory has a row of its own, "NAME (optimized)". Invalid runs are left out;
/// without a valid one there are no scores.
TextTable score_table(std::span<const RunRecord> runs);

}  // namespace aims
