// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <string>

#include "bench/scoring/score_record.hpp"

namespace aims {

/// A run of a suite as its page shows it, with a link to its own page where one lies there.
/// `record`: its scores, of which those of the keys in `headline` lead; null when its jobs have
/// none.
Json suite_run_json(const std::string& scenario, std::uint64_t seed, const RunRecord* record,
                    const std::filesystem::path& run_folder,
                    const std::filesystem::path& page_folder, const Json& headline);

/// Keys of the scores that lead; `first`, if there is one, before all others.
Json headline_keys(const std::string& first = "");

/// Names of all estimators of a suite.json, in the order in which its scenarios have them.
std::vector<std::string> suite_estimators(const Json& suite);

}  // namespace aims
