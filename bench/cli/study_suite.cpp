// SPDX-License-Identifier: BSD-3-Clause
#include "bench/cli/study_suite.hpp"

#include <fmt/format.h>

#include <numeric>
#include <utility>

#include "bench/cli/suite_options.hpp"
#include "bench/cli/terminal.hpp"

namespace aims {

Result<Suite> run_study(const SharedOptions& shared, const StudySuite& study) {
  auto options = suite_options(shared, study.seeds);
  if (!options) return tl::unexpected(options.error());
  options->jobs.outputs = study.outputs;
  auto scenarios = study_scenarios(shared);
  if (!scenarios) return tl::unexpected(scenarios.error());
  if (study.adapt) {
    if (auto adapted = study.adapt(*scenarios); !adapted) return tl::unexpected(adapted.error());
  }
  return run_with_display(std::move(*scenarios), *options, shared.quiet);
}

std::vector<std::uint64_t> first_seeds(std::uint64_t count) {
  std::vector<std::uint64_t> seeds(count);
  std::iota(seeds.begin(), seeds.end(), 1);
  return seeds;
}

Result<std::string> one_estimator(const SharedOptions& options, const std::string& absent) {
  const auto specs = joined_specs(options.estimators);
  if (specs.empty()) return absent;
  if (specs.size() == 1) return specs.front();
  return failure(fmt::format("--estimators: expected one estimator, found {}", specs.size()));
}

int exit_code_of(const char* command, const Result<int>& result) {
  return result ? *result : bad_input(command, result.error());
}

}  // namespace aims
