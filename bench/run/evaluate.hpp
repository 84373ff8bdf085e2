// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <string>

#include "bench/run/sequence_file.hpp"
#include "bench/run/run.hpp"
#include "bench/run/scenario.hpp"
#include "bench/run/score_record.hpp"
#include "core/error.hpp"

namespace aims {

/// A sequence that was simulated before, ready for any number of estimators, with all that their
/// scores have in common.
struct Sequence {
  SequenceReader reader;
  RunResult run;  ///< truth and localizability; no estimators
};

/// Opens the file of the scenario's sequence (bench/jobs/sequence_cache.hpp). Reads the truth; the
/// measurements stay in the file.
Result<Sequence> open_sequence(const std::filesystem::path& file, const Scenario& scenario);

/// Runs one estimator, with its settings on top of the scenario's, over the sequence and scores it, on
/// the calling thread. The outcome, but for wall times, is that of `run` on the same scenario and
/// seed. Error for a spec or a sequence that cannot be read.
Result<EstimatorOutcome> evaluate(const Sequence& sequence, const Scenario& scenario,
                                  const std::string& estimator);

}  // namespace aims
