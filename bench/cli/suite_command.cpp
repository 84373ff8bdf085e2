// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <string>
#include <vector>

#include "bench/cli/commands.hpp"
#include "bench/cli/exit_code.hpp"
#include "bench/cli/interrupt.hpp"
#include "bench/cli/options.hpp"
#include "bench/cli/report_command.hpp"
#include "bench/cli/suite_selection.hpp"
#include "bench/studies/families.hpp"
#include "bench/studies/suite.hpp"
#include "bench/studies/suite_tables.hpp"

namespace aims {
namespace {

namespace fs = std::filesystem;

struct SuiteArguments {
  SuiteSelection selection;
  bool trajectories = false;
  bool no_report = false;
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
  const SuiteSelection& selection = arguments.selection;
  auto options = suite_options(selection);
  if (!options) return bad_input("suite", options.error());
  options->trajectories = arguments.trajectories;
  auto scenarios = scenarios_of(selection);
  if (!scenarios) return bad_input("suite", scenarios.error());
  watch_interrupt();
  SuiteDisplay display(selection.quiet);
  const auto suite = run_suite(std::move(*scenarios), *options, display.observer());
  display.close();
  if (!suite) return bad_input("suite", suite.error());
  print_report(*suite, options->out);
  if (!arguments.no_report) show_reports(options->out);
  return exit_code_of(*suite);
}

}  // namespace

void add_suite_command(CLI::App& app, const fs::path& scenario_folder, int& exit_code) {
  auto* command = app.add_subcommand(
      "suite", "Run many scenarios on many seeds; continues what was interrupted");
  auto arguments = std::make_shared<SuiteArguments>();
  SuiteSelection& selection = arguments->selection;
  selection.folder = scenario_folder.string();
  selection.out = "out/suite";
  auto* names = command->add_option("--scenarios", selection.scenarios,
                                    "Scenario files or names, e.g. corridor,severity_5");
  names->delimiter(',');
  add_suite_options(*command, selection, names);
  command
      ->add_option("--estimators", selection.estimators,
                   "Instead of each scenario's own:\n"
                   "NAME or LABEL=NAME+key=value, keys below estimator.")
      ->delimiter(',');
  command->add_flag("--trajectories", arguments->trajectories,
                    "Keep trajectories and diagnostics of each run");
  command->add_flag("--no-report", arguments->no_report, "Write no pages (page.html)");
  command->footer(
      "Examples:\n"
      "  aims suite --tags severity --seeds 1-10 --out out/severity\n"
      "  aims suite --scenarios corridor,corridor_smooth --seeds 1-5 --estimators aims,lio\n"
      "  aims suite --tags stress --seeds 1-3 --set estimator.degeneracy.eta=5 --out out/eta5\n"
      "The same command again continues, and runs only what is missing or has changed.\n"
      "Exit codes: as of aims; 2 also when a scenario could not run.");
  command->callback([arguments, &exit_code] { exit_code = suite_command(*arguments); });
}

}  // namespace aims
