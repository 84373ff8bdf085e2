// SPDX-License-Identifier: BSD-3-Clause
#include <memory>
#include <string>
#include <vector>

#include "bench/studies/ablation.hpp"
#include "bench/studies/suite_summary.hpp"
#include "cli/commands.hpp"
#include "cli/suite_options.hpp"
#include "cli/terminal.hpp"
#include "estimator/estimator_spec.hpp"

namespace aims {
namespace {

namespace fs = std::filesystem;

struct AblationArguments {
  SharedOptions shared;
  std::vector<std::string> groups;
  std::vector<std::string> baselines;
};

void print_ablation(const Ablation& ablation) {
  for (const AblationCase& each : ablation.cases) {
    if (each.rows.empty()) continue;
    print_out("{}, median over {} seeds (ratio to {})\n{}\n", each.scenario, each.rows.front().runs,
              ablation.complete, to_text(case_table(each)));
  }
  print_out("Geometric mean of the ratios over scenarios\n{}\n", to_text(effect_table(ablation)));
}

Result<int> study_ablation(const AblationArguments& arguments) {
  SharedOptions shared = arguments.shared;
  const auto estimator = one_estimator(shared, "aims_d");
  if (!estimator) return tl::unexpected(estimator.error());
  shared.estimators.clear();  // the study sets its own
  const AblationOptions variants = {*estimator, arguments.groups,
                                    joined_specs(arguments.baselines)};
  const auto adapt = [&](auto& scenarios) { return set_variants(variants, scenarios); };
  const auto suite = run_study(shared, {.seeds = {}, .outputs = {}, .adapt = adapt});
  if (!suite) return tl::unexpected(suite.error());
  const Ablation ablation = ablation_of(*suite, label_of(*estimator));
  auto written = write_suite(*suite, shared.out);
  if (written) written = write_ablation(ablation, *suite, shared.out);
  if (!written) return tl::unexpected(written.error());
  print_ablation(ablation);
  print_outcome(*suite, shared);
  print_out("results: {}, ablation.json, ablation.csv\n",
            (fs::path(shared.out) / "ablation.md").string());
  return exit_code_of(*suite);
}

}  // namespace

void declare_ablation(Command command, const fs::path& scenarios) {
  auto arguments = std::make_shared<AblationArguments>();
  SharedOptions& shared = arguments->shared;
  shared.folder = scenarios.string();
  add_suite_options(command, shared, "out/ablation", "those of each scenario");
  add_estimators(command, shared, "aims_d; one");
  command.list("--groups", arguments->groups,
               "Groups of keys below estimator. whose switches are inverted,\n"
               "one at a time (switches off each part that is on)");
  command.list("--baselines", arguments->baselines,
               "Estimators to compare with, e.g. lio,tfs_clean");
  command.footer(std::string(kContinues) +
                 "Examples:\n"
                 "  aims study ablation severity_3 severity_8 --seeds 1-3 --out out/ablation\n"
                 "  aims study ablation --tags severity --seeds 1-5 --baselines lio,tfs_clean\n"
                 "  aims study ablation severity_5 --groups leg_states");
  command.action(
      [arguments] { return exit_code_of("study ablation", study_ablation(*arguments)); });
}

}  // namespace aims
