// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "bench/cli/options.hpp"
#include "bench/studies/suite.hpp"
#include "core/error.hpp"

namespace aims {

/// What `aims suite` and the studies on a suite have in common: scenarios, seeds, --set, --out,
/// --cache, --jobs, --retry, --quiet.
void add_suite_options(Command& command, SharedOptions& options, const std::string& folder,
                       const std::string& seeds);

/// Seeds (without --seeds `absent`), folder and jobs.
Result<SuiteOptions> suite_options(const SharedOptions& options,
                                   const std::vector<std::uint64_t>& absent);

/// The scenarios of a study, which must be named or have a tag.
Result<std::vector<ScenarioFile>> study_scenarios(const SharedOptions& options);

/// Does the jobs of the scenarios and shows how far they are; Ctrl-C ends it early.
Result<Suite> run_with_display(std::vector<ScenarioFile> scenarios, const SuiteOptions& options,
                               bool quiet);

/// Prints how many jobs were done, what failed, and whether the suite was interrupted.
void print_outcome(const Suite& suite, const SharedOptions& options);

/// Of a suite whose expectations do not count.
int exit_code_of(const Suite& suite);

}  // namespace aims
