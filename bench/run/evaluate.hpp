// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <string>

#include "bench/run/sequence.hpp"
#include "bench/scenario/scenario.hpp"
#include "bench/scoring/outcome.hpp"
#include "core/error.hpp"

namespace aims {

/// Scores an outcome against the truth of its sequence, the re-optimized trajectory by the same
/// rules as the online one. On an invalid run (bench/scoring/validity.hpp) neither is a success.
void add_scores(const Sequence& sequence, const Scenario& scenario, EstimatorOutcome& outcome);

/// Called with the part of the sequence that is done, in [0, 1].
using PartObserver = std::function<void(double)>;

/// Runs one estimator, with its settings on top of the scenario's, over the sequence and scores it,
/// on the calling thread. Error for a spec or a sequence that cannot be read.
Result<EstimatorOutcome> evaluate(const Sequence& sequence, const Scenario& scenario,
                                  const std::string& estimator, const PartObserver& observer);

}  // namespace aims
