// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "bench/scenario/scenario.hpp"
#include "core/error.hpp"

namespace aims {

/// Dotted keys of the scores that an estimator can have in a run of the scenario, those of a
/// re-optimized trajectory included; without counters (`counts.`), which depend on what happens.
std::vector<std::string> possible_score_keys(const Scenario& scenario);

/// Dotted keys of the numbers that scores.json has of a run whoever estimates, e.g. "robot.fell".
std::vector<std::string> possible_run_score_keys(const Scenario& scenario);

/// Error, which begins with `key` and has the nearest key, for a score that no estimator can have.
Result<void> check_score(std::string_view key, const std::string& score, const Scenario& scenario);

/// The same for a score of the run itself.
Result<void> check_run_score(std::string_view key, const std::string& score,
                             const Scenario& scenario);

}  // namespace aims
