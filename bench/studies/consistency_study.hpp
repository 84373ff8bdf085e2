// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "bench/metrics/consistency.hpp"
#include "bench/studies/suite.hpp"
#include "core/error.hpp"
#include "core/files/table.hpp"

namespace aims {

/// Version of the layout of consistency.json; see docs/results.md.
inline constexpr std::string_view kConsistencySchema = "aims.consistency/1";

/// One estimator on one scenario.
struct ConsistencyCase {
  std::string scenario;
  std::string estimator;             ///< its label
  std::vector<std::uint64_t> seeds;  ///< of `runs`, in order
  std::vector<ConsistencyRun> runs;
  Consistency result;
};

struct ConsistencyStudy {
  std::vector<ConsistencyCase> cases;
  Suite suite;
};

/// Judges what a suite with `weak_axis_series` yielded.
ConsistencyStudy consistency_study(Suite suite);

/// Runs every scenario on every seed as `run_suite` does, which also continues what was
/// interrupted, and holds the error along the true weak axis against the covariance that each
/// estimator states and against the posterior bound. Writes consistency.md, consistency.csv,
/// consistency.json and a picture per scenario and estimator beside the suite's files.
Result<ConsistencyStudy> run_consistency(std::vector<ScenarioFile> scenarios,
                                         const SuiteOptions& options,
                                         const SuiteObserver& observer);

/// A row per scenario and estimator: NEES, coverage, efficiency.
TextTable consistency_table(const ConsistencyStudy& study);

/// A row per scenario and estimator: error at the end of the walk against what is stated and
/// bounds.
TextTable end_table(const ConsistencyStudy& study);

/// Writes tables and pictures into `folder`.
Result<void> write_consistency(const ConsistencyStudy& study, const std::filesystem::path& folder);

}  // namespace aims
