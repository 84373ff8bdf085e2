// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <span>
#include <string>
#include <vector>

#include "bench/scoring/score_record.hpp"

namespace aims {

/// A line per estimator that failed by poses that are missing or invalid, or over several runs by
/// its error: "mine on 4 of 4 seeds: gap: no poses for too long, at 10.0 s". Invalid runs
/// are left out; of a single run, the table of scores has the time of its error.
std::vector<std::string> failure_lines(std::span<const RunRecord> runs);

}  // namespace aims
