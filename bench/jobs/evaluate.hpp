// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <string>

#include "bench/jobs/walk_file.hpp"
#include "bench/run/run.hpp"
#include "bench/run/scenario.hpp"
#include "bench/run/score_record.hpp"
#include "core/error.hpp"

namespace aims {

/// A walk that was simulated before, ready for any number of estimators, with all that their
/// scores have in common.
struct RecordedWalk {
  WalkReader reader;
  RunResult run;  ///< truth and localizability; no estimators
};

/// Opens the file of the scenario's walk (bench/jobs/walk_cache.hpp). Reads the truth; the
/// measurements stay in the file.
Result<RecordedWalk> open_walk(const std::filesystem::path& file, const Scenario& scenario);

/// Runs one estimator, with its settings on top of the scenario's, over the walk and scores it, on
/// the calling thread. The outcome, but for wall times, is that of `run` on the same scenario and
/// seed. Error for a spec or a walk that cannot be read.
Result<EstimatorOutcome> evaluate(const RecordedWalk& walk, const Scenario& scenario,
                                  const std::string& estimator);

}  // namespace aims
