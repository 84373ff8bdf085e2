// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "bench/run/score_record.hpp"
#include "core/error.hpp"

namespace aims {

/// Reads a scores.json; error when it is not one, e.g. cut short.
Result<RunRecord> read_record(const std::filesystem::path& file);

/// Runs by scenario, in order of their seeds.
using StoredResults = std::map<std::string, std::vector<RunRecord>>;

/// Reads the results that `aims run` (one seed or several) or `aims suite` wrote into `folder`;
/// of a suite, what its suite.json lists. Runs that were interrupted are left out. Error when the
/// folder holds no results, or one that cannot be read.
Result<StoredResults> read_results(const std::filesystem::path& folder);

}  // namespace aims
