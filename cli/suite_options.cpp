// SPDX-License-Identifier: BSD-3-Clause
#include "cli/suite_options.hpp"

#include <fmt/format.h>
#include <algorithm>
#include <map>
#include <numeric>
#include <set>
#include <string>
#include <utility>

#include "bench/run/estimator_fit.hpp"
#include "bench/scenario/scenario_draws.hpp"
#include "cli/progress.hpp"
#include "cli/terminal.hpp"

namespace aims {

void add_suite_options(Command& command, SharedOptions& options, const std::string& folder,
                       const std::string& seeds) {
  add_named_scenarios(command, options);
  add_scenarios(command, options);
  add_seeds(command, options, seeds);
  add_robot_seed(command, options);
  add_settings(command, options, "each scenario");
  add_continued_out(command, options, folder);
  add_cache(command, options);
  add_jobs(command, options);
  add_retry(command, options);
  add_overwrite(command, options);
  add_quiet(command, options);
}

Result<SuiteOptions> suite_options(const SharedOptions& options,
                                   const std::vector<std::uint64_t>& absent) {
  auto seeds = seeds_of(options, absent);
  if (!seeds) return tl::unexpected(seeds.error());
  SuiteOptions suite;
  suite.seeds = std::move(*seeds);
  suite.jobs = job_options(options);
  suite.jobs.redo = options.overwrite;
  return suite;
}

Result<std::vector<ScenarioFile>> study_scenarios(const SharedOptions& options) {
  if (options.named.empty() && options.scenarios.empty() && options.tags.empty()) {
    return failure("expected scenarios or --tags");
  }
  return scenarios_of(options);
}

Result<Suite> run_with_display(std::vector<ScenarioFile> scenarios, const SuiteOptions& options,
                               bool quiet) {
  watch_interrupt();
  JobDisplay display(quiet);
  return run_suite(std::move(scenarios), options, display.observer());
}

void print_expectations(const Suite& suite) {
  for (const SuiteCase& each : suite.cases) {
    for (const ExpectationCheck& check : failed(each.expectations)) {
      print_out("EXPECTATION FAILED: {}\n  to repeat: {}\n", text_of(each.scenario, check),
                reproducing_command(each.scenario, check));
    }
  }
}

namespace {

std::vector<InvalidRun> undemanded_runs(const SuiteCase& each) {
  return aims::undemanded_runs(each.runs, check_expectations(each.scenario, each.runs));
}

/// A line per invalid run, loud unless the scenario demands it.
void print_invalid(const Suite& suite) {
  for (const SuiteCase& each : suite.cases) {
    const auto undemanded = undemanded_runs(each);
    for (const auto& [seed, reason] : invalid_runs(each.runs)) {
      const bool demanded = std::ranges::none_of(
          undemanded, [seed = seed](const InvalidRun& run) { return run.seed == seed; });
      print_out("{}{} seed {}: {}{}\n", demanded ? "" : "INVALID RUN: ", each.scenario.name, seed,
                reason,
                demanded ? ", as the scenario demands"
                         : "; it is no success, and left out of all statistics");
    }
  }
}

}  // namespace

void print_ring_notes(const Suite& suite) {
  std::set<std::string> notes;
  for (const SuiteCase& each : suite.cases) {
    for (std::string& note : ring_notes(each.scenario)) notes.insert(std::move(note));
  }
  for (const std::string& note : notes) print_out("note: {}\n", note);
}

namespace {

/// How the robots of the seeds differ from that of the calibration, with the seeds of each: a
/// scenario may draw sensors.
std::map<std::string, std::vector<std::uint64_t>> misfits_of_seeds(
    const RobotCalibration& calibration, const SuiteCase& each) {
  std::map<std::string, std::vector<std::uint64_t>> seeds;
  for (const RunRecord& run : each.runs) {
    const auto found = misfits(calibration, scenario_of_seed(each.scenario, run.seed));
    if (!found.empty()) seeds[fmt::format("{}", fmt::join(found, ", "))].push_back(run.seed);
  }
  return seeds;
}

}  // namespace

void print_calibration_warnings(const Suite& suite, const SharedOptions& options) {
  if (options.calibration.empty()) return;
  const auto calibration = read_robot_calibration(options.calibration);
  if (!calibration) return;
  if (const std::string idle = nothing_used(*calibration, options.calibration); !idle.empty()) {
    print_out("note: {}\n", idle);
  }
  for (const SuiteCase& each : suite.cases) {
    for (const auto& [differences, seeds] : misfits_of_seeds(*calibration, each)) {
      const std::string drawn =
          each.scenario.draw.empty() ? "" : fmt::format(" seed {}", fmt::join(seeds, ", "));
      print_out("warning: {}{}: not the robot of the calibration {}: {}\n", each.scenario.name,
                drawn, options.calibration, differences);
    }
  }
}

void print_outcome(const Suite& suite, const SharedOptions& options) {
  const bool cached = suite.run.done > 0 && suite.run.sequences == 0;
  print_out("{} jobs done, {} found finished, {}\n", suite.run.done, suite.run.reused,
            cached ? "sequences from the cache"
                   : fmt::format("{} sequences simulated", suite.run.sequences));
  print_pruned(suite.run.pruned, options);
  for (const RunFailure& each : joined(suite.failures)) print_out("FAILED: {}\n", text_of(each));
  print_invalid(suite);
  if (!suite.complete) print_out("interrupted: the same command continues\n");
}

int exit_code_of(const Suite& suite) {
  if (!suite.complete) return interrupted_code();
  if (!suite.failures.empty()) {
    const bool loaded = std::ranges::all_of(
        suite.failures, [](const RunFailure& each) { return each.seed.has_value(); });
    return loaded ? kExpectationFailed : kBadInput;
  }
  const bool as_demanded = std::ranges::all_of(
      suite.cases, [](const SuiteCase& each) { return undemanded_runs(each).empty(); });
  return as_demanded ? kOk : kInvalidRun;
}

int exit_code_with_expectations(const Suite& suite) {
  const int code = exit_code_of(suite);
  const bool hold = std::all_of(suite.cases.begin(), suite.cases.end(), [](const SuiteCase& each) {
    return failed(each.expectations).empty();
  });
  return code == kOk && !hold ? kExpectationFailed : code;
}

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

void print_invalid_poses(const SuiteCase& each) {
  for (const RunRecord& run : each.runs) {
    for (const auto& [name, scores] : run.scores["estimators"].items()) {
      const int invalid = value_in(scores, "poses_invalid", 0);
      if (invalid == 0) continue;
      print_out(
          "warning: {} {} seed {}: {} of {} poses left out: not finite, not rigid, or more than "
          "1000 km from the origin\n",
          each.scenario.name, name, run.seed, invalid, value_in(scores, "poses", 0));
    }
  }
}

}  // namespace aims
