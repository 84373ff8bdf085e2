// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <limits>
#include <span>
#include <string>

#include "bench/scoring/json_text.hpp"
#include "bench/tuning/sweep_summary.hpp"
#include "core/files/table.hpp"

namespace aims {

/// A row per estimator and point: the varied values, the objective ("-" while sequences are
/// missing), median and largest score over its runs that have it, diverged runs. The default
/// setting comes first; the least objective of an estimator is marked "best". Of an estimator with
/// more than `most` points the defaults and those of least objective are kept.
TextTable point_table(std::span<const SweepResponse> responses, const Objective& objective,
                      std::size_t most = std::numeric_limits<std::size_t>::max());

/// The same of one estimator: `estimator`, `objective` (what it is), `incomplete` and `points`,
/// each with `values`, `objective`, `score_median`, `score_worst`, `diverged`, `runs`, `default`,
/// `best`, `resolved` (points differ by more than seeds scatter).
Json response_json(const SweepResponse& response, const Objective& objective);

}  // namespace aims
