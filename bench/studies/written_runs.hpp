// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <vector>

#include "bench/scoring/json_text.hpp"
#include "bench/studies/suite.hpp"
#include "core/error.hpp"

namespace aims {

/// Writes the results of one scenario and seed as `aims run` shows them into `folder`: scores.json,
/// scores.csv, config.yaml, the files of the sequence (bench/run/sequence.hpp) and of each
/// estimator (bench/scoring/result_files.hpp). Those that jobs made are linked, not copied,
/// where the disk can.
Result<void> write_run(const JobStore& store, const Suite& suite, const SuiteCase& each,
                       const RunRecord& record, const std::filesystem::path& folder);

/// What scores.json of a run holds: the record with the scenario's expectations.
Json run_scores(const Scenario& scenario, const RunRecord& record);

/// Schema aims.run/1: `run_scores` of every run of the suite's only scenario, and its failures.
Json run_json(const Suite& suite, const std::filesystem::path& out);

/// The folders that `write_runs` fills: `out` itself for one run, `out/seed-N` for several.
std::vector<std::filesystem::path> run_folders(const Suite& suite,
                                               const std::filesystem::path& out);

/// Removes the runs, pictures, summaries and pages that `run` or `suite` wrote into `out` before,
/// by their manifests (core/files/manifest.hpp). The store of jobs and files of others stay.
void remove_earlier_runs(const std::filesystem::path& out);

/// Writes every run of a suite of one scenario, and of several seeds a summary over them;
/// nothing else of an earlier invocation stays.
Result<void> write_runs(const Suite& suite, const std::filesystem::path& out);

/// Writes every run of a suite into `out/runs/SCENARIO/seed-N`.
Result<void> write_suite_runs(const Suite& suite, const std::filesystem::path& out);

/// Lists the tables of a suite in the manifest of its folder, to which pages are added.
Result<void> list_suite(const std::filesystem::path& out);

/// Where `write_suite_runs` puts a run.
std::filesystem::path suite_run_folder(const std::filesystem::path& out,
                                       const std::string& scenario, std::uint64_t seed);

}  // namespace aims
