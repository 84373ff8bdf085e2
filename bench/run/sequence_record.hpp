// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "bench/run/scenario_draws.hpp"
#include "bench/run/score_record.hpp"
#include "bench/run/sequence.hpp"

namespace aims {

/// How the robot fared, without whether the run is valid.
Json robot_json(const WalkOutcome& walk);

/// What the seed drew: numbers as numbers, by their full keys.
Json drawn_json(const std::vector<DrawnValue>& drawn);

/// What scores.json holds of a run whoever estimates: duration, robot, segments, localizability.
/// `scores` are of any estimator.
Json sequence_json(const Sequence& sequence, const Scores& scores);
Json sequence_json(double simulated_s, const WalkOutcome& walk, const Scores& scores,
                   const RunLocalizability& localizability);

}  // namespace aims
