// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>

#include <memory>
#include <string>
#include <vector>

#include "bench/cli/commands.hpp"
#include "bench/cli/exit_code.hpp"
#include "bench/cli/interrupt.hpp"
#include "bench/cli/options.hpp"
#include "bench/run/seeds.hpp"
#include "bench/studies/detector_report.hpp"
#include "bench/studies/detectors.hpp"
#include "core/files/table.hpp"
#include "estimator/estimator_spec.hpp"

namespace aims {
namespace {

namespace fs = std::filesystem;

struct DetectorArguments {
  std::vector<std::string> scenarios;
  std::string seeds = "1-5";
  std::string estimator = "aims";
  std::vector<std::string> overrides;
  std::string out = "out/detectors";
  int jobs = default_jobs();
  bool overwrite = false;
  bool quiet = false;
};

Result<std::vector<Scenario>> scenarios_of(const DetectorArguments& arguments,
                                           const fs::path& folder) {
  std::vector<std::string> overrides = arguments.overrides;
  overrides.push_back(estimators_setting({&arguments.estimator, 1}));
  std::vector<Scenario> scenarios;
  for (const std::string& given : arguments.scenarios) {
    const auto file = find_scenario(given, folder);
    if (!file) return tl::unexpected(file.error());
    auto scenario = load_scenario(*file, overrides);
    if (!scenario) return tl::unexpected(scenario.error());
    scenarios.push_back(std::move(*scenario));
  }
  return scenarios;
}

int bad_input(const Error& error) {
  fmt::print(stderr, "aims detectors: {}\n", error.message);
  return interrupted() ? kInterrupted : kBadInput;
}

void print_report(const DetectorStudy& study) {
  fmt::print(
      "{} runs; AUC with 95 % interval over runs, detected at {:.0f} % false alarms, median "
      "delay, onsets missed\n{}\n",
      study.runs.size(), 100.0 * kFalseAlarms, to_text(detector_table(study.scores)));
  for (const std::string& warning : study.warnings) fmt::print("note: {}\n", warning);
  fmt::print("results: {}\n", (study.folder / "").string());
}

int detectors_command(const DetectorArguments& arguments, const fs::path& folder) {
  const auto scenarios = scenarios_of(arguments, folder);
  if (!scenarios) return bad_input(scenarios.error());
  const auto seeds = parse_seeds(arguments.seeds);
  if (!seeds) return bad_input(seeds.error());
  DetectorOptions options;
  options.seeds = *seeds;
  options.estimator = arguments.estimator;
  options.out = arguments.out;
  options.overwrite = arguments.overwrite;
  options.jobs = arguments.jobs;
  watch_interrupt();
  const auto study =
      run_detectors(*scenarios, options, [&](const std::string& label, int done, int of) {
        if (!arguments.quiet) fmt::print(stderr, "{}/{} {}\n", done, of, label);
        return !interrupted();
      });
  if (!study) return bad_input(study.error());
  print_report(*study);
  return kOk;
}

}  // namespace

void add_detectors_command(CLI::App& app, const fs::path& scenario_folder, int& exit_code) {
  auto* command = app.add_subcommand(
      "detectors", "Judge an estimator's degeneracy indices as detectors against the truth");
  auto arguments = std::make_shared<DetectorArguments>();
  command->add_option("scenarios", arguments->scenarios, "Scenario files, or their bare names")
      ->required();
  command->add_option("--seeds,--seed", arguments->seeds, "Seeds of each scenario (1-5)");
  command->add_option("--estimator", arguments->estimator, "Whose indices (aims)");
  add_repeatable(*command, "--set", arguments->overrides, "key=value on top of each scenario");
  command->add_option("--out", arguments->out, "Folder for the results (out/detectors)");
  add_jobs_option(*command, arguments->jobs, "Runs at a time; the results do not depend on it");
  command->add_flag("--overwrite", arguments->overwrite, "Replace results that exist");
  command->add_flag("--quiet", arguments->quiet, "No progress, the table alone");
  command->footer(
      "Example:\n"
      "  aims detectors corridor corridor_smooth --seeds 1-5 --out out/detectors");
  command->callback([arguments, scenario_folder, &exit_code] {
    exit_code = detectors_command(*arguments, scenario_folder);
  });
}

}  // namespace aims
