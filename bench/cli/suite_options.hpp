// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "bench/cli/options.hpp"
#include "bench/studies/suite.hpp"
#include "core/error.hpp"

namespace aims {

/// What `aims suite` and the studies on a suite have in common: scenarios, seeds, --set, --out,
/// --jobs, --quiet.
void add_suite_options(Command& command, SharedOptions& options, const std::string& folder,
                       const std::string& seeds);

/// Seeds (without --seeds `absent`), folder and jobs.
Result<SuiteOptions> suite_options(const SharedOptions& options,
                                   const std::vector<std::uint64_t>& absent);

/// The scenarios of a study, which must be named or have a tag.
Result<std::vector<ScenarioFile>> study_scenarios(const SharedOptions& options);

/// Prints how many runs were simulated and how many found.
void print_counts(const Suite& suite);

/// Prints what could not run, and whether the suite was interrupted.
void print_outcome(const Suite& suite);

/// Of a suite whose expectations do not count.
int exit_code_of(const Suite& suite);

}  // namespace aims
