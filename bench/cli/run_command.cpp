// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>

#include <memory>
#include <string>
#include <vector>

#include "bench/cli/commands.hpp"
#include "bench/cli/exit_code.hpp"
#include "bench/cli/interrupt.hpp"
#include "bench/cli/options.hpp"
#include "bench/cli/progress_display.hpp"
#include "bench/cli/report_command.hpp"
#include "bench/run/experiment.hpp"
#include "bench/run/score_table.hpp"
#include "bench/run/seeds.hpp"
#include "estimator/estimator_spec.hpp"
#include "render/results/pictures.hpp"

namespace aims {
namespace {

namespace fs = std::filesystem;

struct RunArguments {
  std::string scenario;
  std::string seeds;
  std::vector<std::string> estimators;
  std::vector<std::string> overrides;
  std::string out;
  int jobs = default_jobs();
  bool overwrite = false;
  bool quiet = false;
  bool no_pictures = false;
  bool no_report = false;
};

Result<Scenario> scenario_of(const RunArguments& arguments, const fs::path& folder) {
  const auto file = find_scenario(arguments.scenario, folder);
  if (!file) return tl::unexpected(file.error());
  std::vector<std::string> overrides = arguments.overrides;
  if (!arguments.estimators.empty()) {
    overrides.push_back(estimators_setting(joined_specs(arguments.estimators)));
  }
  return load_scenario(*file, overrides);
}

Result<ExperimentOptions> options_of(const RunArguments& arguments, const Scenario& scenario) {
  ExperimentOptions options;
  options.seeds = {static_cast<std::uint64_t>(scenario.seed)};
  if (!arguments.seeds.empty()) {
    auto seeds = parse_seeds(arguments.seeds);
    if (!seeds) return tl::unexpected(seeds.error());
    options.seeds = std::move(*seeds);
  }
  options.out = arguments.out;
  if (arguments.out.empty()) {
    const std::string seeds =
        arguments.seeds.empty() ? std::to_string(scenario.seed) : arguments.seeds;
    options.out = fs::path("out") / fmt::format("{}-seed-{}", scenario.name, seeds);
  }
  options.overwrite = arguments.overwrite;
  options.jobs = arguments.jobs;
  options.pictures = !arguments.no_pictures;
  return options;
}

std::string seeds_text(const Experiment& experiment) {
  std::vector<std::uint64_t> seeds;
  for (const RunRecord& run : experiment.runs) seeds.push_back(run.seed);
  const char* meaning = seeds.size() > 1 ? ": median (worst)" : "";
  return fmt::format("{}{}", fmt::join(seeds, ", "), meaning);
}

void print_report(const Scenario& scenario, const Experiment& experiment) {
  fmt::print("{}, seed {}\n{}\n", scenario.name, seeds_text(experiment),
             to_text(score_table(experiment.runs)));
  for (const std::string& warning : experiment.warnings) fmt::print("warning: {}\n", warning);
  for (const GateCheck& failure : experiment.failures) {
    fmt::print("EXPECTATION FAILED: {}\n  again: {}\n", text_of(scenario, failure),
               reproducing_command(scenario, failure));
  }
  if (!experiment.complete) {
    fmt::print("interrupted: the results hold what was walked until then\n");
  }
  fmt::print("results: {}\n", (experiment.folder / "").string());
  for (const fs::path& picture : pictures_in(experiment.folder)) {
    fmt::print("  {}\n", picture.string());
  }
}

int exit_code_of(const Experiment& experiment) {
  if (!experiment.complete) return kInterrupted;
  return experiment.failures.empty() ? kOk : kGateFailed;
}

int run_command(const RunArguments& arguments, const fs::path& folder) {
  const auto scenario = scenario_of(arguments, folder);
  if (!scenario) return bad_input("run", scenario.error());
  const auto options = options_of(arguments, *scenario);
  if (!options) return bad_input("run", options.error());

  watch_interrupt();
  ProgressDisplay display(scenario->name, arguments.quiet);
  const auto experiment =
      run_experiment(*scenario, *options, [&](std::uint64_t seed, const Progress& progress) {
        display.show(seed, progress);
        return !interrupted();
      });
  display.close();
  if (!experiment) return bad_input("run", experiment.error());
  print_report(*scenario, *experiment);
  if (!arguments.no_report) show_reports(experiment->folder);
  return exit_code_of(*experiment);
}

}  // namespace

void add_run_command(CLI::App& app, const fs::path& scenario_folder, int& exit_code) {
  auto* command =
      app.add_subcommand("run", "Simulate a scenario, estimate, score, draw, write results");
  auto arguments = std::make_shared<RunArguments>();
  command->add_option("scenario", arguments->scenario, "Scenario file, or its bare name")
      ->required();
  command->add_option("--seed", arguments->seeds, "Seed, range or list: 3, 1-5, 1,4,7-9");
  command
      ->add_option("--estimators", arguments->estimators,
                   "Estimators to run, e.g. aims,lio or\n"
                   "loose=aims+leg.scale_sigma=0.1")
      ->delimiter(',');
  add_repeatable(*command, "--set", arguments->overrides,
                 "key=value on top of the scenario; repeatable");
  command->add_option("--out", arguments->out, "Folder for the results (out/SCENARIO-seed-N)");
  add_jobs_option(*command, arguments->jobs, "Threads; the results do not depend on it");
  command->add_flag("--overwrite", arguments->overwrite, "Replace results that exist");
  command->add_flag("--quiet", arguments->quiet, "No progress, the table alone");
  command->add_flag("--no-pictures", arguments->no_pictures, "Draw nothing");
  command->add_flag("--no-report", arguments->no_report, "Write no page (page.html)");
  command->footer(
      "Examples:\n"
      "  aims run scenarios/paper/corridor.yaml\n"
      "  aims run corridor --seed 1-5 --set lidar.range_max=30 --out out/short-sighted");
  command->callback([arguments, scenario_folder, &exit_code] {
    exit_code = run_command(*arguments, scenario_folder);
  });
}

}  // namespace aims
