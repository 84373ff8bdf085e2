// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <string>

#include "core/error.hpp"
#include "harness/run.hpp"
#include "harness/scenario.hpp"
#include "harness/score_record.hpp"
#include "harness/sweep/walk_file.hpp"

namespace aims {

/// A walk that was simulated before, ready for any number of estimators, with all that their
/// scores have in common.
struct RecordedWalk {
  WalkReader reader;
  RunResult run;  ///< truth and localizability; no estimators
};

/// Opens the file of the scenario's walk (harness/sweep/walk_cache.hpp). Reads the truth; the
/// measurements stay in the file.
Result<RecordedWalk> open_walk(const std::filesystem::path& file, const Scenario& scenario);

/// Runs one estimator, with its settings on top of the scenario's, over the walk and scores it, on
/// the calling thread. The outcome, but for wall times, is that of `run` on the same scenario and
/// seed. Error for a spec or a walk that cannot be read.
Result<EstimatorOutcome> evaluate(const RecordedWalk& walk, const Scenario& scenario,
                                  const std::string& estimator);

}  // namespace aims
