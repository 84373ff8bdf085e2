// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "bench/studies/suite.hpp"
#include "cli/options.hpp"
#include "core/error.hpp"

namespace aims {

/// The options of `aims suite` and of the studies on a suite: scenarios, seeds, --set, --out,
/// --cache, --jobs, --retry, --overwrite, --quiet.
void add_suite_options(Command& command, SharedOptions& options, const std::string& folder,
                       const std::string& seeds);

/// Seeds (without --seeds `absent`), folder, cache and jobs.
Result<SuiteOptions> suite_options(const SharedOptions& options,
                                   const std::vector<std::uint64_t>& absent);

/// The scenarios of a study, which must be named or have a tag.
Result<std::vector<ScenarioFile>> study_scenarios(const SharedOptions& options);

/// Runs the jobs with a line of progress, until Ctrl-C.
Result<Suite> run_with_display(std::vector<ScenarioFile> scenarios, const SuiteOptions& options,
                               bool quiet);

/// Prints the expectations that failed, each with the command that repeats it.
void print_expectations(const Suite& suite);

/// Prints which estimators the LiDARs of the scenarios do not fit, each once.
void print_ring_notes(const Suite& suite);

/// Prints that --calibration is of another robot than that of a scenario, or that nothing of it is
/// used.
void print_calibration_warnings(const Suite& suite, const SharedOptions& options);

/// Prints how many jobs were done, those that failed, and whether the suite was interrupted.
void print_outcome(const Suite& suite, const SharedOptions& options);

/// Interrupted, bad input for a scenario that does not load, 1 for failed jobs, or success.
int exit_code_of(const Suite& suite);

/// The same, where a failed expectation counts.
int exit_code_with_expectations(const Suite& suite);

inline constexpr const char* kContinues =
    "The same command again continues, and runs only what is missing or has changed.\n";

/// How the suite of a study differs from what the command line states.
struct StudySuite {
  std::vector<std::uint64_t> seeds;  ///< without --seeds; empty: those of each scenario
  JobOutputs outputs;
  /// Changes the scenarios before they run, e.g. their estimators; empty: they stay.
  std::function<Result<void>(std::vector<ScenarioFile>&)> adapt;
};

/// Runs the scenarios of the command line, which must be named or have a tag, with a line of
/// progress.
Result<Suite> run_study(const SharedOptions& options, const StudySuite& study);

/// The seeds 1 to `count`.
std::vector<std::uint64_t> first_seeds(std::uint64_t count);

/// The one estimator of --estimators; `absent` without it.
Result<std::string> one_estimator(const SharedOptions& options, const std::string& absent);

/// The exit code of a command that came to an end; its error is printed as bad input.
int exit_code_of(const char* command, const Result<int>& result);

/// Prints a line per seed and estimator with poses that no score can take.
void print_invalid_poses(const SuiteCase& each);

}  // namespace aims
