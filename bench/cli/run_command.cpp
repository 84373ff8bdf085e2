// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>

#include <memory>
#include <string>
#include <vector>

#include "bench/cli/commands.hpp"
#include "bench/cli/options.hpp"
#include "bench/cli/progress.hpp"
#include "bench/run/experiment.hpp"
#include "bench/run/score_table.hpp"
#include "render/results/pictures.hpp"

namespace aims {
namespace {

namespace fs = std::filesystem;

struct RunArguments {
  SharedOptions shared;
  bool no_pictures = false;
  bool no_page = false;
};

Result<ExperimentOptions> options_of(const RunArguments& arguments, const Scenario& scenario) {
  const SharedOptions& shared = arguments.shared;
  ExperimentOptions options;
  auto seeds = seeds_of(shared, {static_cast<std::uint64_t>(scenario.seed)});
  if (!seeds) return tl::unexpected(seeds.error());
  options.seeds = std::move(*seeds);
  options.out = shared.out;
  if (shared.out.empty()) {
    const std::string text = shared.seeds.empty() ? std::to_string(scenario.seed) : shared.seeds;
    options.out = fs::path("out") / fmt::format("{}-seed-{}", scenario.name, text);
  }
  options.overwrite = shared.overwrite;
  options.jobs = shared.jobs;
  options.pictures = !arguments.no_pictures;
  return options;
}

std::string seeds_text(const Experiment& experiment) {
  std::vector<std::uint64_t> seeds;
  for (const RunRecord& run : experiment.runs) seeds.push_back(run.seed);
  return fmt::format("{}{}", fmt::join(seeds, ", "), seeds.size() > 1 ? ": median (worst)" : "");
}

void print_results(const Scenario& scenario, const Experiment& experiment) {
  fmt::print("{}, seed {}\n{}\n", scenario.name, seeds_text(experiment),
             to_text(score_table(experiment.runs)));
  for (const std::string& warning : experiment.warnings) fmt::print("warning: {}\n", warning);
  for (const GateCheck& failure : experiment.failures) {
    fmt::print("EXPECTATION FAILED: {}\n  to repeat: {}\n", text_of(scenario, failure),
               reproducing_command(scenario, failure));
  }
  if (!experiment.complete) fmt::print("interrupted: the results end where the run was stopped\n");
  fmt::print("results: {}\n", (experiment.folder / "").string());
  for (const fs::path& picture : pictures_in(experiment.folder)) {
    fmt::print("  {}\n", picture.string());
  }
}

int run_command(const RunArguments& arguments) {
  const auto scenario = scenario_of(arguments.shared);
  if (!scenario) return bad_input("run", scenario.error());
  const auto options = options_of(arguments, *scenario);
  if (!options) return bad_input("run", options.error());
  watch_interrupt();
  ProgressDisplay display(scenario->name, arguments.shared.quiet);
  const auto experiment = run_experiment(
      *scenario, *options,
      [&](std::uint64_t seed, const Progress& progress) { return display.show(seed, progress); });
  display.close();
  if (!experiment) return bad_input("run", experiment.error());
  print_results(*scenario, *experiment);
  if (!arguments.no_page) write_pages_of(experiment->folder);
  if (!experiment->complete) return kInterrupted;
  return experiment->failures.empty() ? kOk : kGateFailed;
}

}  // namespace

void declare_run(Command command, const fs::path& scenarios) {
  auto arguments = std::make_shared<RunArguments>();
  SharedOptions& shared = arguments->shared;
  shared.folder = scenarios.string();
  add_scenario(command, shared, Presence::kRequired);
  add_folder(command, shared);
  add_seeds(command, shared, "that of the scenario");
  add_estimators(command, shared, "those of the scenario");
  add_settings(command, shared);
  add_out(command, shared, "out/SCENARIO-seed-N");
  add_overwrite(command, shared);
  add_jobs(command, shared);
  add_quiet(command, shared);
  command.flag("--no-pictures", arguments->no_pictures, "Draw no pictures");
  command.flag("--no-page", arguments->no_page, "Write no HTML page");
  command.footer(
      "Examples:\n"
      "  aims run scenarios/paper/corridor.yaml\n"
      "  aims run corridor --seeds 1-5 --set lidar.range_max=30 --out out/short-range");
  command.action([arguments] { return run_command(*arguments); });
}

}  // namespace aims
