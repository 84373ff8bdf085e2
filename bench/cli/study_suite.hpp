// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "bench/cli/options.hpp"
#include "bench/studies/suite.hpp"
#include "core/error.hpp"

namespace aims {

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

}  // namespace aims
