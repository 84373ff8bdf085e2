// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <span>

#include "bench/scenario/scenario.hpp"
#include "bench/scoring/run_failure.hpp"
#include "bench/scoring/score_record.hpp"
#include "core/error.hpp"

namespace aims {

/// Several seeds of a scenario.
struct SeedRuns {
  const Scenario& scenario;
  std::span<const RunRecord> runs;       ///< those with a finished estimator
  std::span<const RunFailure> failures;  ///< of all seeds
  bool complete = true;                  ///< all jobs have ended
};

/// Writes summary.json, summary.csv and summary.md (the score table) into `folder`.
Result<void> write_summary(const SeedRuns& seeds, const std::filesystem::path& folder);

}  // namespace aims
