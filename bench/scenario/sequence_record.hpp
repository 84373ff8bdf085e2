// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <span>
#include <vector>

#include "bench/metrics/localizability.hpp"
#include "bench/metrics/posterior_bound.hpp"
#include "bench/scenario/scenario_draws.hpp"
#include "bench/scoring/score_record.hpp"
#include "core/walk_outcome.hpp"

namespace aims {

/// How the robot fared, without whether the run is valid.
Json robot_json(const WalkOutcome& walk);

/// What the seed drew: numbers as numbers, by their full keys.
Json drawn_json(const std::vector<DrawnValue>& drawn);

/// What scores.json holds of a run whoever estimates: duration, robot, segments, localizability.
/// `scores` are of any estimator; `scans` and `bounds` are what the scans constrain.
Json sequence_json(double simulated_s, const WalkOutcome& walk, const Scores& scores,
                   std::span<const Localizability> scans, std::span<const PosteriorBound> bounds);

}  // namespace aims
