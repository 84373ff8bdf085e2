// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <memory>
#include <string>
#include <vector>

#include "app/commands.hpp"
#include "app/exit_code.hpp"
#include "app/interrupt.hpp"
#include "app/options.hpp"
#include "harness/families.hpp"
#include "harness/seeds.hpp"
#include "harness/suite.hpp"
#include "harness/suite_tables.hpp"

namespace aims {
namespace {

namespace fs = std::filesystem;

struct SuiteArguments {
  std::string folder;
  std::vector<std::string> scenarios;
  std::vector<std::string> tags;
  std::string seeds;
  std::vector<std::string> estimators;
  std::vector<std::string> overrides;
  std::string out = "out/suite";
  int jobs = default_jobs();
  bool trajectories = false;
  bool quiet = false;
};

Result<std::vector<ScenarioFile>> scenarios_of(const SuiteArguments& arguments) {
  std::vector<std::string> overrides = arguments.overrides;
  if (!arguments.estimators.empty()) {
    overrides.push_back(fmt::format("estimators=[{}]", fmt::join(arguments.estimators, ", ")));
  }
  if (arguments.scenarios.empty()) {
    return scenarios_in(arguments.folder, arguments.tags, overrides);
  }
  std::vector<ScenarioFile> files;
  for (const std::string& given : arguments.scenarios) {
    const auto file = find_scenario(given, arguments.folder);
    if (!file) return tl::unexpected(file.error());
    files.push_back({*file, load_scenario(*file, overrides)});
  }
  return files;
}

std::string duration_text(double seconds) {
  const int whole = static_cast<int>(seconds + 0.5);
  if (whole < 60) return fmt::format("{} s", whole);
  if (whole < 3600) return fmt::format("{} min", (whole + 59) / 60);
  return fmt::format("{} h {:02} min", whole / 3600, whole % 3600 / 60);
}

/// Shows how far the suite is: a line that changes on a terminal, a line per run elsewhere.
class SuiteDisplay {
 public:
  explicit SuiteDisplay(bool quiet) : quiet_(quiet) {}
  ~SuiteDisplay() {
    if (open_) fmt::print(stderr, "\n");
  }

  void show(const SuiteProgress& progress) {
    if (quiet_ || (!terminal_ && progress.done == shown_)) return;
    shown_ = progress.done;
    const std::string left =
        progress.left_s ? ", " + duration_text(*progress.left_s) + " left" : "";
    fmt::print(stderr, "{}{} of {} runs, {}{}{}", terminal_ ? "\r" : "", progress.done,
               progress.total, duration_text(progress.elapsed_s), left, terminal_ ? "    " : "\n");
    open_ = terminal_;
    std::fflush(stderr);
  }

 private:
  bool quiet_;
  bool terminal_ = isatty(STDERR_FILENO) != 0;
  bool open_ = false;
  std::size_t shown_ = 0;
};

void print_matrix(const char* title, const TextTable& table) {
  fmt::print("{}\n{}\n", title, to_text(table));
}

void print_failures(const Suite& suite) {
  for (const SuiteCase& each : suite.cases) {
    for (const GateCheck& check : failed(each.gates)) {
      fmt::print("EXPECTATION FAILED: {}\n  again: {}\n", text_of(each.scenario, check),
                 reproducing_command(each.scenario, check));
    }
  }
  for (const SuiteFailure& each : suite.failures) {
    const std::string seed = each.seed ? fmt::format(" seed {}", *each.seed) : "";
    fmt::print("COULD NOT RUN: {}{}: {}\n", each.scenario, seed, each.message);
  }
}

void print_report(const Suite& suite, const fs::path& out) {
  for (const std::string& note : suite.notes) fmt::print("note: {}\n", note);
  fmt::print("{} runs simulated, {} found finished\n\n", suite.runs_done, suite.runs_reused);
  fmt::print("median [95 % bootstrap interval] worst, over seeds\n\n");
  print_matrix("M_list over all segments [%]", headline_table(suite, kHeadlineScores[0]));
  print_matrix("M_end [m]", headline_table(suite, kHeadlineScores[1]));
  print_matrix("localized to the end", success_table(suite));
  const auto families = family_results(suite);
  if (!families.empty()) print_matrix("breaks at level", breaks_table(families));
  print_failures(suite);
  if (!suite.complete) fmt::print("interrupted: the same command continues\n");
  fmt::print("results: {}, suite.json, suite.csv\n", (out / "suite.md").string());
}

int exit_code_of(const Suite& suite) {
  if (!suite.complete) return kInterrupted;
  if (!suite.failures.empty()) return kBadInput;
  const bool hold = std::all_of(suite.cases.begin(), suite.cases.end(),
                                [](const SuiteCase& each) { return failed(each.gates).empty(); });
  return hold ? kOk : kGateFailed;
}

int suite_command(const SuiteArguments& arguments) {
  SuiteOptions options;
  options.out = arguments.out;
  options.jobs = arguments.jobs;
  options.trajectories = arguments.trajectories;
  if (!arguments.seeds.empty()) {
    auto seeds = parse_seeds(arguments.seeds);
    if (!seeds) return bad_input("suite", seeds.error());
    options.seeds = std::move(*seeds);
  }
  auto scenarios = scenarios_of(arguments);
  if (!scenarios) return bad_input("suite", scenarios.error());
  if (scenarios->empty()) {
    return bad_input("suite", {fmt::format("{}: holds no scenario", arguments.folder)});
  }
  watch_interrupt();
  auto display = std::make_unique<SuiteDisplay>(arguments.quiet);
  const auto suite = run_suite(std::move(*scenarios), options, [&](const SuiteProgress& progress) {
    display->show(progress);
    return !interrupted();
  });
  display.reset();
  if (!suite) return bad_input("suite", suite.error());
  print_report(*suite, options.out);
  return exit_code_of(*suite);
}

}  // namespace

void add_suite_command(CLI::App& app, const fs::path& scenario_folder, int& exit_code) {
  auto* command = app.add_subcommand(
      "suite", "Run many scenarios on many seeds; continues what was interrupted");
  auto arguments = std::make_shared<SuiteArguments>();
  arguments->folder = scenario_folder.string();
  command->add_option("--folder", arguments->folder,
                      "Folder of scenarios, searched with those in it");
  auto* names = command->add_option("--scenarios", arguments->scenarios,
                                    "Scenario files or names, e.g. corridor,dial_r05");
  names->delimiter(',');
  command->add_option("--tags", arguments->tags, "All scenarios with any of these tags")
      ->delimiter(',')
      ->excludes(names);
  command->add_option("--seeds", arguments->seeds,
                      "Range or list: 1-10, 1,4,7-9; each scenario's own when absent");
  command->add_option("--estimators", arguments->estimators, "Instead of each scenario's own")
      ->delimiter(',');
  add_repeatable(*command, "--set", arguments->overrides, "key=value on top of every scenario");
  command->add_option("--out", arguments->out, "Folder that is filled or continued (out/suite)");
  add_jobs_option(*command, arguments->jobs, "Runs at a time; the results do not depend on it");
  command->add_flag("--trajectories", arguments->trajectories,
                    "Keep trajectories and diagnostics of each run");
  command->add_flag("--quiet", arguments->quiet, "No progress");
  command->footer(
      "Examples:\n"
      "  aims suite --tags dial --seeds 1-10 --out out/dial\n"
      "  aims suite --scenarios corridor,corridor_smooth --seeds 1-5 --estimators aims,lio\n"
      "  aims suite --tags stress --seeds 1-3 --set estimator.degeneracy.eta=5 --out out/eta5\n"
      "The same command again continues, and runs only what is missing or has changed.\n"
      "Exit codes: as of aims; 2 also when a scenario could not run.");
  command->callback([arguments, &exit_code] { exit_code = suite_command(*arguments); });
}

}  // namespace aims
