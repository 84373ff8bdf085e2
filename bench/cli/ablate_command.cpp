// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>

#include <memory>
#include <string>
#include <vector>

#include "bench/cli/commands.hpp"
#include "bench/cli/exit_code.hpp"
#include "bench/cli/interrupt.hpp"
#include "bench/cli/options.hpp"
#include "bench/cli/suite_selection.hpp"
#include "bench/studies/ablation.hpp"

namespace aims {
namespace {

namespace fs = std::filesystem;

struct AblateArguments {
  SuiteSelection selection;
  std::string estimator = "aims_d";
  std::vector<std::string> groups = {"directional"};
  std::vector<std::string> others;
};

void print_report(const Ablation& ablation, const fs::path& out) {
  fmt::print("{} runs simulated, {} found finished\n\n", ablation.suite.runs_done,
             ablation.suite.runs_reused);
  for (const AblationCase& each : ablation.cases) {
    if (each.rows.empty()) continue;
    fmt::print("{}, median over {} seeds (ratio to {})\n{}\n", each.scenario,
               each.rows.front().runs, ablation.whole, to_text(case_table(each)));
  }
  fmt::print("Geometric mean of the ratios over scenarios\n{}\n", to_text(worth_table(ablation)));
  print_outcome(ablation.suite);
  fmt::print("results: {}, ablation.json, ablation.csv\n", (out / "ablation.md").string());
}

int ablate_command(const AblateArguments& arguments) {
  AblationOptions options;
  options.estimator = arguments.estimator;
  options.groups = arguments.groups;
  const SuiteSelection& selection = arguments.selection;
  auto suite = suite_options(selection);
  if (!suite) return bad_input("ablate", suite.error());
  options.suite = std::move(*suite);
  options.others = joined_specs(arguments.others);
  auto scenarios = scenarios_of(selection);
  if (!scenarios) return bad_input("ablate", scenarios.error());
  watch_interrupt();
  SuiteDisplay display(selection.quiet);
  const auto ablation = run_ablation(std::move(*scenarios), options, display.observer());
  display.close();
  if (!ablation) return bad_input("ablate", ablation.error());
  print_report(*ablation, options.suite.out);
  if (!ablation->suite.complete) return kInterrupted;
  return ablation->suite.failures.empty() ? kOk : kBadInput;
}

}  // namespace

void add_ablate_command(CLI::App& app, const fs::path& scenario_folder, int& exit_code) {
  auto* command = app.add_subcommand(
      "ablate", "What each switch of an estimator is worth: all on, and each off, on one stream");
  auto arguments = std::make_shared<AblateArguments>();
  SuiteSelection& selection = arguments->selection;
  selection.folder = scenario_folder.string();
  selection.out = "out/ablation";
  auto* names =
      command->add_option("scenarios", selection.scenarios, "Scenario files, or their bare names");
  add_suite_options(*command, selection, names);
  command->add_option("--estimator", arguments->estimator,
                      "Who is taken apart: NAME or LABEL=NAME+key=value (aims_d)");
  command
      ->add_option("--groups", arguments->groups,
                   "Groups below estimator. whose flags are turned over (directional)")
      ->delimiter(',');
  command->add_option("--others", arguments->others, "Run beside it, e.g. lio,tfs_clean")
      ->delimiter(',');
  command->footer(
      "Examples:\n"
      "  aims ablate severity_3 severity_8 severity_9 --seeds 1-3 --out out/ablation\n"
      "  aims ablate --tags severity --seeds 1-5 --others lio,tfs_clean\n"
      "  aims ablate severity_5 --groups directional.leg_states\n"
      "The same command again continues, and runs only what is missing or has changed.\n"
      "Exit codes: as of aims; 2 also when a scenario could not run.");
  command->callback([arguments, &exit_code] { exit_code = ablate_command(*arguments); });
}

}  // namespace aims
