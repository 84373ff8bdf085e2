// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <map>
#include <span>
#include <string>
#include <vector>

#include "bench/jobs/job.hpp"
#include "bench/scoring/score_record.hpp"
#include "core/error.hpp"

namespace aims {

/// The result of a job under the label that its estimator has in tables.
struct LabelledResult {
  std::string label;
  JobResult result;
};

/// What the jobs of one scenario and seed came to, as one record; those that failed stand under
/// `failures`. `complete`: whether all of them have ended.
RunRecord record_of(const std::string& scenario, std::uint64_t seed,
                    std::span<const LabelledResult> results, bool complete = true);

/// Records by scenario, in order of their seeds.
using StoredResults = std::map<std::string, std::vector<RunRecord>>;

/// Reads the results of the jobs that `folder` lists, or the scores.json of `aims score` and
/// `aims estimate`. Error when the folder holds no finished results, or one that cannot be read.
Result<StoredResults> read_results(const std::filesystem::path& folder);

}  // namespace aims
