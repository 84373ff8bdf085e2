// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>

#include <memory>
#include <optional>
#include <string>

#include "bench/estimate/new_recording.hpp"
#include "bench/run/expectations.hpp"
#include "bench/run/record.hpp"
#include "bench/scenario/sequence_record.hpp"
#include "bench/scoring/validity.hpp"
#include "cli/commands.hpp"
#include "cli/options.hpp"
#include "cli/progress.hpp"
#include "cli/terminal.hpp"

namespace aims {
namespace {

namespace fs = std::filesystem;

struct SimulateArguments {
  SharedOptions shared;
  std::string compression = "none";
  std::optional<double> fast_imu_hz;
};

/// What was written, and what is wrong with it; `quiet` leaves the first out.
void print_results(const RecordOutcome& outcome, const RecordOptions& options, bool quiet) {
  if (!quiet) {
    print_out("{}: {:.1f} MB, {:.1f} s simulated in {:.1f} s\n", options.bag.string(),
              static_cast<double>(outcome.bag_bytes) / 1e6, outcome.simulated_s, outcome.wall_s);
    print_out("  {}\n  {}\n", outcome.truth.string(), outcome.waypoint_times.string());
  }
  if (outcome.walk.touched_wall) print_out("warning: the robot touched a wall\n");
  if (outcome.left_out > 0) {
    print_out("warning: {} messages from before time 0 were left out: ROS has no negative time\n",
              outcome.left_out);
  }
  if (!outcome.complete) {
    print_out("interrupted: the bag ends where the simulation was stopped\n");
  }
}

/// Whether the walk may have ended as it did: the run is valid, or the scenario demands what makes
/// it invalid. Prints one that is invalid.
bool is_as_demanded(const RecordOutcome& outcome, const Scenario& scenario, std::uint64_t seed) {
  RunRecord run{seed, {{"simulated_s", outcome.simulated_s}, {"robot", robot_json(outcome.walk)}}};
  mark_validity(run.scores);
  const auto reason = invalid_reason(run.scores);
  if (!reason) return true;
  const bool demanded = undemanded_runs({&run, 1}, check_expectations(scenario, {&run, 1})).empty();
  print_out("{}{} seed {}: {}{}\n", demanded ? "" : "INVALID RUN: ", scenario.name, seed, *reason,
            demanded ? ", as the scenario demands" : "; the bag is kept");
  return demanded;
}

int simulate_command(const SimulateArguments& arguments) {
  SharedOptions shared = arguments.shared;
  if (const auto format = format_of_new(shared.out); !format) {
    return bad_input("simulate", {"--out " + format.error().message});
  }
  const auto read = check_settings(shared.settings, {"estimators", "run", "scoring"}, true);
  if (!read) return bad_input("simulate", read.error());
  if (arguments.fast_imu_hz) {
    shared.settings.push_back(fmt::format("fast_imu_rate={}", *arguments.fast_imu_hz));
  }
  const auto scenario = scenario_of(shared);
  if (!scenario) return bad_input("simulate", scenario.error());
  const auto seed = seed_of(shared, *scenario);
  if (!seed) return bad_input("simulate", seed.error());
  RecordOptions options;
  options.seed = *seed;
  options.bag = shared.out;
  options.overwrite = shared.overwrite;
  options.compression = *compression_named(arguments.compression);
  watch_interrupt();
  ProgressDisplay display(scenario->name, shared.quiet);
  const auto outcome = record(*scenario, options, [&](const Progress& progress) {
    return display.show(options.seed, progress);
  });
  display.close();
  if (!outcome) return bad_input("simulate", outcome.error());
  print_results(*outcome, options, shared.quiet);
  if (!outcome->complete) return interrupted_code();
  return is_as_demanded(*outcome, *scenario, options.seed) ? kOk : kInvalidRun;
}

}  // namespace

void declare_simulate(Command command, const fs::path& scenarios) {
  auto arguments = std::make_shared<SimulateArguments>();
  SharedOptions& shared = arguments->shared;
  shared.folder = scenarios.string();
  add_scenario(command, shared, Presence::kRequired);
  add_folder(command, shared);
  command.option("-o,--out", shared.out,
                 "Recording to write: NAME.bag, NAME.mcap, or NAME/ for rosbag2",
                 Presence::kRequired);
  add_seeds(command, shared, "that of the scenario; one");
  add_robot_seed(command, shared);
  add_settings(command, shared);
  command.option("--fast-imu", arguments->fast_imu_hz, {1.0, 2000.0},
                 "Rate of a second IMU topic [Hz], e.g. 200 (none)");
  add_compression(command, arguments->compression);
  add_overwrite(command, shared);
  add_quiet(command, shared);
  command.footer(
      "Also writes NAME.truth.tum (true poses of the body) and NAME.waypoint_times.csv.\n"
      "Examples:\n"
      "  aims simulate corridor --out corridor.bag\n"
      "  aims simulate corridor --out corridor.mcap --compression zstd\n"
      "  aims simulate corridor --out corridor/\n"
      "  aims simulate garage --seeds 3 --fast-imu 200 --compression lz4 --out garage.bag");
  command.action([arguments] { return simulate_command(*arguments); });
}

}  // namespace aims
