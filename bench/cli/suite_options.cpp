// SPDX-License-Identifier: BSD-3-Clause
#include "bench/cli/suite_options.hpp"

#include <fmt/format.h>

namespace aims {

void add_suite_options(Command& command, SharedOptions& options, const std::string& folder,
                       const std::string& seeds) {
  add_named_scenarios(command, options);
  add_scenarios(command, options);
  add_seeds(command, options, seeds);
  add_settings(command, options, "each scenario");
  add_continued_out(command, options, folder);
  add_jobs(command, options);
  add_quiet(command, options);
}

Result<SuiteOptions> suite_options(const SharedOptions& options,
                                   const std::vector<std::uint64_t>& absent) {
  auto seeds = seeds_of(options, absent);
  if (!seeds) return tl::unexpected(seeds.error());
  SuiteOptions suite;
  suite.seeds = std::move(*seeds);
  suite.out = options.out;
  suite.jobs = options.jobs;
  return suite;
}

Result<std::vector<ScenarioFile>> study_scenarios(const SharedOptions& options) {
  if (options.named.empty() && options.scenarios.empty() && options.tags.empty()) {
    return failure("expected scenarios or --tags");
  }
  return scenarios_of(options);
}

void print_counts(const Suite& suite) {
  for (const std::string& note : suite.notes) fmt::print("note: {}\n", note);
  fmt::print("{} runs simulated, {} found finished\n\n", suite.runs_done, suite.runs_reused);
}

void print_outcome(const Suite& suite) {
  for (const SuiteFailure& each : suite.failures) {
    const std::string seed = each.seed ? fmt::format(" seed {}", *each.seed) : "";
    fmt::print("COULD NOT RUN: {}{}: {}\n", each.scenario, seed, each.message);
  }
  if (!suite.complete) fmt::print("interrupted: the same command continues\n");
}

int exit_code_of(const Suite& suite) {
  if (!suite.complete) return kInterrupted;
  return suite.failures.empty() ? kOk : kBadInput;
}

}  // namespace aims
