// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>

#include <memory>
#include <string>

#include "bench/cli/commands.hpp"
#include "bench/cli/exit_code.hpp"
#include "bench/cli/interrupt.hpp"
#include "bench/cli/options.hpp"
#include "bench/cli/suite_selection.hpp"
#include "bench/studies/consistency_study.hpp"

namespace aims {
namespace {

namespace fs = std::filesystem;

void print_report(const ConsistencyStudy& study, const fs::path& out) {
  fmt::print("{} runs simulated, {} found finished\n\n", study.suite.runs_done,
             study.suite.runs_reused);
  fmt::print("Along the weak axis, over the walk\n{}\n", to_text(consistency_table(study)));
  fmt::print("At the end of the walk, root mean squares over seeds [m]\n{}\n",
             to_text(end_table(study)));
  print_outcome(study.suite);
  fmt::print("results: {}, consistency.json, consistency.csv, pictures\n",
             (out / "consistency.md").string());
}

int consistency_command(const SuiteSelection& selection) {
  const auto options = suite_options(selection);
  if (!options) return bad_input("consistency", options.error());
  auto scenarios = scenarios_of(selection);
  if (!scenarios) return bad_input("consistency", scenarios.error());
  watch_interrupt();
  SuiteDisplay display(selection.quiet);
  const auto study = run_consistency(std::move(*scenarios), *options, display.observer());
  display.close();
  if (!study) return bad_input("consistency", study.error());
  print_report(*study, options->out);
  if (!study->suite.complete) return kInterrupted;
  return study->suite.failures.empty() ? kOk : kBadInput;
}

}  // namespace

void add_consistency_command(CLI::App& app, const fs::path& scenario_folder, int& exit_code) {
  auto* command = app.add_subcommand(
      "consistency", "Hold errors along the weak axis against stated covariance and bound");
  auto selection = std::make_shared<SuiteSelection>();
  selection->folder = scenario_folder.string();
  selection->out = "out/consistency";
  selection->seeds = "1-10";
  auto* names =
      command->add_option("scenarios", selection->scenarios, "Scenario files, or their bare names");
  add_suite_options(*command, *selection, names);
  command
      ->add_option("--estimators,--estimator", selection->estimators,
                   "Instead of each scenario's own:\n"
                   "NAME or LABEL=NAME+key=value, keys below estimator.")
      ->delimiter(',');
  command->footer(
      "Examples:\n"
      "  aims consistency severity_3 severity_8 --seeds 1-50 --estimators aims_d,lio\n"
      "  aims consistency severity_9 --estimators aims_d,learning=aims_d+"
      "directional.leg_states.gate_learning=false\n"
      "Seeds 1-10 when absent. The same command again continues.\n"
      "Exit codes: as of aims; 2 also when a scenario could not run.");
  command->callback([selection, &exit_code] { exit_code = consistency_command(*selection); });
}

}  // namespace aims
