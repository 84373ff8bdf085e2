// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "bench/jobs/job_runner.hpp"
#include "bench/run/expectations.hpp"
#include "bench/scenario/catalogue.hpp"
#include "bench/scoring/run_failure.hpp"
#include "bench/scoring/score_record.hpp"
#include "core/error.hpp"

namespace aims {

struct SuiteOptions {
  std::vector<std::uint64_t> seeds;  ///< of every scenario; empty: each scenario's own
  JobOptions jobs;
  Shard shard;
};

/// One scenario of a suite and its finished runs, by seed.
struct SuiteCase {
  Scenario scenario;
  std::vector<RunRecord> runs;
  std::vector<ExpectationCheck> expectations;  ///< none before all of its jobs have ended
};

/// Scenarios, seeds and estimators, and what their jobs came to.
struct Suite {
  std::vector<SuiteCase> cases;
  std::vector<Job> jobs;  ///< by case, seed and estimator
  std::vector<RunFailure> failures;
  std::vector<std::string> settings;  ///< "key=value" on top of every scenario, but who runs
  std::string lead_score;             ///< key of the score that goes first; empty: the headline
  std::string lead_unit;              ///< of that score, as the data set states it
  bool complete = true;               ///< false when jobs are missing
  JobRun run;                         ///< what this invocation did
};

/// Does the jobs of every scenario, seed and estimator that `options.jobs.out` lacks, and collects
/// what is there. Error when the folder holds something else or is in use, two scenarios have one
/// name, or no scenario loads.
Result<Suite> run_suite(std::vector<ScenarioFile> scenarios, const SuiteOptions& options,
                        const JobObserver& observer);

/// Reads the results of the suite's jobs into its cases, and checks the expectations of those that
/// ended.
void collect_suite(const JobStore& store, Suite& suite);

/// A line per scenario with invalid runs, which are left out of all statistics (validity.hpp):
/// "severity_3: 1 of 5 runs are invalid and left out: seed 2 (the robot fell at 1.2 s)".
std::vector<std::string> left_out_lines(const Suite& suite);

/// What the JSON document of every study over a suite begins with: schema, version, code and
/// whether all jobs have ended.
Json study_head(std::string_view schema, const Suite& suite);

/// The invalid runs, each with scenario, seed and reason.
Json invalid_json(const Suite& suite);

}  // namespace aims
