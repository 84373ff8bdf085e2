// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>

#include <map>
#include <memory>
#include <string>
#include <vector>

#include "bench/cli/commands.hpp"
#include "bench/cli/exit_code.hpp"
#include "bench/cli/interrupt.hpp"
#include "bench/cli/options.hpp"
#include "bench/cli/progress_display.hpp"
#include "bench/run/record.hpp"
#include "bench/run/seeds.hpp"

namespace aims {
namespace {

namespace fs = std::filesystem;

struct SimulateArguments {
  std::string scenario;
  std::string seed;
  std::vector<std::string> overrides;
  std::string out;
  BagCompression compression = BagCompression::kNone;
  double fast_imu = 0.0;
  bool overwrite = false;
  bool quiet = false;
};

const std::map<std::string, BagCompression> kCompressions = {
    {"none", BagCompression::kNone}, {"lz4", BagCompression::kLz4}, {"bz2", BagCompression::kBz2}};

Result<Scenario> scenario_of(const SimulateArguments& arguments, const fs::path& folder) {
  const auto file = find_scenario(arguments.scenario, folder);
  if (!file) return tl::unexpected(file.error());
  std::vector<std::string> overrides = arguments.overrides;
  if (arguments.fast_imu > 0.0) {
    overrides.push_back(fmt::format("fast_imu_rate={}", arguments.fast_imu));
  }
  return load_scenario(*file, overrides);
}

Result<RecordOptions> options_of(const SimulateArguments& arguments, const Scenario& scenario) {
  RecordOptions options;
  options.seed = static_cast<std::uint64_t>(scenario.seed);
  if (!arguments.seed.empty()) {
    const auto seeds = parse_seeds(arguments.seed);
    if (!seeds) return tl::unexpected(seeds.error());
    if (seeds->size() != 1) return failure("--seed: expected one seed: a bag holds one walk");
    options.seed = seeds->front();
  }
  options.bag = arguments.out;
  options.overwrite = arguments.overwrite;
  options.compression = arguments.compression;
  return options;
}

void print_report(const RecordOutcome& outcome, const RecordOptions& options) {
  const double megabytes = static_cast<double>(outcome.bag_bytes) / 1e6;
  fmt::print("{}: {:.1f} MB, {:.1f} s simulated in {:.1f} s\n", options.bag.string(), megabytes,
             outcome.simulated_s, outcome.wall_s);
  fmt::print("  {}\n  {}\n", outcome.truth.string(), outcome.waypoint_times.string());
  if (outcome.fell) fmt::print("warning: the robot fell\n");
  if (outcome.touched_wall) fmt::print("warning: the robot touched a wall\n");
  if (outcome.left_out > 0) {
    fmt::print("warning: {} messages from before time 0 were left out: ROS has no negative time\n",
               outcome.left_out);
  }
  if (!outcome.complete) fmt::print("interrupted: the bag holds what was walked until then\n");
}

int simulate_command(const SimulateArguments& arguments, const fs::path& folder) {
  const auto scenario = scenario_of(arguments, folder);
  if (!scenario) return bad_input("simulate", scenario.error());
  const auto options = options_of(arguments, *scenario);
  if (!options) return bad_input("simulate", options.error());
  watch_interrupt();
  ProgressDisplay display(scenario->name, arguments.quiet);
  const auto outcome = record(*scenario, *options, [&](const Progress& progress) {
    display.show(options->seed, progress);
    return !interrupted();
  });
  display.close();
  if (!outcome) return bad_input("simulate", outcome.error());
  print_report(*outcome, *options);
  return outcome->complete ? kOk : kInterrupted;
}

}  // namespace

void add_simulate_command(CLI::App& app, const fs::path& scenario_folder, int& exit_code) {
  auto* command = app.add_subcommand("simulate", "Record a scenario's measurements as a ROS 1 bag");
  auto arguments = std::make_shared<SimulateArguments>();
  command->add_option("scenario", arguments->scenario, "Scenario file, or its bare name")
      ->required();
  command->add_option("-o,--out", arguments->out, "Bag to write, e.g. walk.bag")->required();
  command->add_option("--seed", arguments->seed, "Seed of the walk (the scenario's)");
  add_repeatable(*command, "--set", arguments->overrides,
                 "key=value on top of the scenario; repeatable");
  command
      ->add_option("--fast-imu", arguments->fast_imu,
                   "Rate [Hz] of a second IMU topic, e.g. 200 (none)")
      ->check(CLI::Range(1.0, 2000.0));
  command->add_option("--compression", arguments->compression, "none, lz4 or bz2 (none)")
      ->transform(CLI::CheckedTransformer(kCompressions));
  command->add_flag("--overwrite", arguments->overwrite, "Replace a bag that exists");
  command->add_flag("--quiet", arguments->quiet, "No progress");
  command->footer(
      "Beside the bag stand NAME.truth.tum (true poses of the body) and NAME.waypoint_times.csv.\n"
      "Examples:\n"
      "  aims simulate corridor -o walk.bag\n"
      "  aims simulate garage --seed 3 --fast-imu 200 --compression lz4 -o garage.bag");
  command->callback([arguments, scenario_folder, &exit_code] {
    exit_code = simulate_command(*arguments, scenario_folder);
  });
}

}  // namespace aims
