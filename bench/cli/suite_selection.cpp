// SPDX-License-Identifier: BSD-3-Clause
#include "bench/cli/suite_selection.hpp"

#include <fmt/format.h>

#include <cstdio>

#include "bench/cli/interrupt.hpp"
#include "bench/run/seeds.hpp"
#include "estimator/estimator_spec.hpp"

namespace aims {

std::string duration_text(double seconds) {
  const int whole = static_cast<int>(seconds + 0.5);
  if (whole < 60) return fmt::format("{} s", whole);
  if (whole < 3600) return fmt::format("{} min", (whole + 59) / 60);
  return fmt::format("{} h {:02} min", whole / 3600, whole % 3600 / 60);
}

void add_suite_options(CLI::App& command, SuiteSelection& selection, CLI::Option* names) {
  command.add_option("--folder", selection.folder,
                     "Folder of scenarios, searched with those in it");
  command.add_option("--tags", selection.tags, "All scenarios with any of these tags")
      ->delimiter(',')
      ->excludes(names);
  command.add_option("--seeds,--seed", selection.seeds,
                     "Range or list: 1-10, 1,4,7-9; each scenario's own when absent");
  add_repeatable(command, "--set", selection.overrides, "key=value on top of every scenario");
  command.add_option("--out", selection.out,
                     fmt::format("Folder that is filled or continued ({})", selection.out));
  add_jobs_option(command, selection.jobs, "Runs at a time; the results do not depend on it");
  command.add_flag("--quiet", selection.quiet, "No progress");
}

Result<std::vector<ScenarioFile>> scenarios_of(const SuiteSelection& selection) {
  std::vector<std::string> overrides = selection.overrides;
  if (!selection.estimators.empty()) {
    overrides.push_back(estimators_setting(joined_specs(selection.estimators)));
  }
  if (selection.scenarios.empty()) {
    auto files = scenarios_in(selection.folder, selection.tags, overrides);
    if (files && files->empty()) {
      return failure(fmt::format("{}: holds no scenario", selection.folder));
    }
    return files;
  }
  std::vector<ScenarioFile> files;
  for (const std::string& given : selection.scenarios) {
    const auto file = find_scenario(given, selection.folder);
    if (!file) return tl::unexpected(file.error());
    files.push_back({*file, load_scenario(*file, overrides)});
  }
  return files;
}

Result<SuiteOptions> suite_options(const SuiteSelection& selection) {
  SuiteOptions options;
  options.out = selection.out;
  options.jobs = selection.jobs;
  if (selection.seeds.empty()) return options;
  auto seeds = parse_seeds(selection.seeds);
  if (!seeds) return tl::unexpected(seeds.error());
  options.seeds = std::move(*seeds);
  return options;
}

SuiteObserver SuiteDisplay::observer() {
  return [this](const SuiteProgress& progress) {
    show(progress);
    return !interrupted();
  };
}

void SuiteDisplay::close() {
  if (open_) fmt::print(stderr, "\n");
  open_ = false;
}

void SuiteDisplay::show(const SuiteProgress& progress) {
  if (quiet_ || (!terminal_ && progress.done == shown_)) return;
  shown_ = progress.done;
  const std::string left = progress.left_s ? ", " + duration_text(*progress.left_s) + " left" : "";
  fmt::print(stderr, "{}{} of {} runs, {}{}{}", terminal_ ? "\r" : "", progress.done,
             progress.total, duration_text(progress.elapsed_s), left, terminal_ ? "    " : "\n");
  open_ = terminal_;
  std::fflush(stderr);
}

void print_outcome(const Suite& suite) {
  for (const std::string& note : suite.notes) fmt::print("note: {}\n", note);
  for (const SuiteFailure& each : suite.failures) {
    const std::string seed = each.seed ? fmt::format(" seed {}", *each.seed) : "";
    fmt::print("COULD NOT RUN: {}{}: {}\n", each.scenario, seed, each.message);
  }
  if (!suite.complete) fmt::print("interrupted: the same command continues\n");
}

}  // namespace aims
