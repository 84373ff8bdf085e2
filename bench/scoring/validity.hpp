// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "bench/scoring/score_record.hpp"
#include "core/walk_outcome.hpp"

namespace aims {

/// Largest fraction of the time under way that a valid run's robot touches walls [-]. Brushing a
/// wall is walking; a robot that leans on one for more than half of its route follows the wall.
inline constexpr double kMaxWallContact = 0.5;

/// Why a run says nothing of its estimators, e.g. "the robot fell at 1.2 s"; none for a valid run,
/// which reached the end of its route. `end_s` is the time at which it ended [s].
std::optional<std::string> invalid_reason(const WalkOutcome& walk, double end_s);

/// The same of what scores.json holds of a run: its walk, or that it was interrupted. Of results
/// without `robot.end`, a run is invalid when its robot fell. What was recorded elsewhere, and has
/// no robot in it, is valid.
std::optional<std::string> invalid_reason(const Json& scores);

/// Sets `robot.valid` and `robot.invalid_reason`, where there is a robot, and of an invalid run the
/// `success` of every estimator to false.
void mark_validity(Json& scores);

/// A run that is left out of all statistics.
struct InvalidRun {
  std::uint64_t seed = 0;
  std::string reason;
};

bool is_valid_run(const RunRecord& run);
std::vector<InvalidRun> invalid_runs(std::span<const RunRecord> runs);

/// `[{"seed": 3, "reason": "the robot fell at 1.2 s"}]`.
Json invalid_json(std::span<const RunRecord> runs);

/// "2 of 5 runs are invalid and left out: seed 3 (the robot fell at 1.2 s), ..."; empty when none.
std::string left_out_text(std::span<const RunRecord> runs);

}  // namespace aims
