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

/// Version of the layout of consistency.json; see docs/result-files.md.
inline constexpr std::string_view kConsistencySchema = "aims.consistency/2";

/// One estimator on one scenario.
struct ConsistencyCase {
  std::string scenario;
  std::string estimator;             ///< its label
  std::vector<std::uint64_t> seeds;  ///< of `runs`, in order
  std::vector<ConsistencyRun> runs;
  Consistency result;
};

using ConsistencyStudy = std::vector<ConsistencyCase>;

/// Holds the error along the true weak axis against the covariance that each estimator states and
/// against the posterior bound, from the jobs of a suite that kept it (`JobOutputs::weak_axis`) in
/// the store `folder`. Error for a file that is missing or cannot be read.
Result<ConsistencyStudy> consistency_study(const Suite& suite,
                                           const std::filesystem::path& folder);

/// A row per scenario and estimator: NEES, coverage, efficiency.
TextTable consistency_table(const ConsistencyStudy& study);

/// A row per scenario and estimator: error at the end of the sequence, stated deviation, bounds.
TextTable end_table(const ConsistencyStudy& study);

/// Writes consistency.md, consistency.csv and consistency.json into `folder`.
Result<void> write_consistency(const ConsistencyStudy& study, const Suite& suite,
                               const std::filesystem::path& folder);

}  // namespace aims
