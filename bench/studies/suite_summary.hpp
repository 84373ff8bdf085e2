// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "bench/scoring/score_statistics.hpp"
#include "bench/studies/suite.hpp"

namespace aims {

/// Version of the layout of suite.json; see docs/result-files.md.
inline constexpr std::string_view kSuiteSchema = "aims.suite/2";

/// Labels of the estimators that any case ran: names in the registry's order, then the others.
std::vector<std::string> estimators_of(const Suite& suite);

/// suite.json without the families.
Json suite_json(const Suite& suite);

/// All of suite.json.
Json suite_document(const Suite& suite);

/// True when `folder` holds the suite.json of a suite.
bool holds_suite(const std::filesystem::path& folder);

/// Writes suite.json, suite.csv, suite.md and timings.csv; see docs/result-files.md. Only
/// timings.csv has times in it.
Result<void> write_suite(const Suite& suite, const std::filesystem::path& folder);

}  // namespace aims
