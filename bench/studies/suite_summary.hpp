// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "bench/scoring/score_statistics.hpp"
#include "bench/studies/families.hpp"
#include "bench/studies/suite.hpp"
#include "core/files/csv.hpp"
#include "core/files/table.hpp"

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

/// Scenario x estimator of one score: "median [low, high] worst" over seeds.
TextTable headline_table(const Suite& suite, const Score& score);

/// Scenario x estimator: successes of all runs, with their interval.
TextTable success_table(const Suite& suite, const Score& score);

/// Pairs of estimators over all their common sequences: on how many each alone is a success, and
/// the p of the sign test over seeds. Only pairs that differ; `all` has the others, too.
TextTable success_pairs_table(const Suite& suite, bool all);

/// Family x estimator: the levels at which each breaks.
TextTable breaks_table(const std::vector<FamilyResult>& families);

/// All tables, expectations that fail, and failures, as Markdown.
std::string suite_markdown(const Suite& suite, const std::vector<FamilyResult>& families);

/// The tables of scores and success, as LaTeX.
std::string suite_latex(const Suite& suite);

/// One row per scenario, seed, estimator and score, but for times.
CsvTable suite_csv(const Suite& suite);

/// One row per scenario, seed and estimator: wall times.
CsvTable timings_csv(const Suite& suite);

}  // namespace aims
