// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>

#include <memory>
#include <string>
#include <string_view>

#include "bench/scenario/scenario_draws.hpp"
#include "cli/options.hpp"
#include "cli/progress.hpp"
#include "cli/terminal.hpp"
#include "core/files/output_folder.hpp"
#include "lab/commands.hpp"
#include "lab/fidelity/fidelity.hpp"

namespace aims {
namespace {

namespace fs = std::filesystem;

constexpr const char* kFidelityName = "fidelity";
constexpr const char* kWalk = "fidelity_walk";
constexpr const char* kWalkOfGo1 = "fidelity_go1_walk";  ///< for the stance profile
constexpr double kStandingTime = 300.0;  ///< of the Allan deviation [s]

void print_fidelity(const Fidelity& fidelity) {
  print_out("IMU while trotting (real: Unitree Go1, 400 Hz)\n{}\n",
            to_text(imu_statistics_table(fidelity.trot)));
  print_out("IMU while standing\n{}\n", to_text(imu_statistics_table(fidelity.standing)));
  print_out("Allan deviation of the standing IMU\n{}\n", to_text(allan_table(fidelity.allan)));
  print_out("Measured minus true range\n{}\n", to_text(range_table(fidelity.ranges)));
  print_out("Leg odometry; below zero: reads short\n{}\n", to_text(leg_drift_table(fidelity.legs)));
  print_out("Stance (real: Unitree Go1 under motion capture)\n{}\n{}\n",
            to_text(stance_profile_table(fidelity.stance)),
            to_text(stance_agreement_table(stance_agreement(fidelity.stance))));
}

/// Prints each step once, unless `quiet`.
FidelityObserver observer_of(bool quiet) {
  return [quiet, shown = std::string()](std::string_view step) mutable {
    if (!quiet && shown != step) print_error(std::string(step));
    shown = step;
    return !interrupted();
  };
}

int fidelity_command(const SharedOptions& given) {
  SharedOptions shared = given;
  if (shared.scenario.empty()) shared.scenario = kWalk;
  const auto scenario = scenario_of(shared);
  if (!scenario) return bad_input(kFidelityName, scenario.error());
  shared.scenario = kWalkOfGo1;
  const auto walk_of_go1 = scenario_of(shared);
  if (!walk_of_go1) return bad_input(kFidelityName, walk_of_go1.error());
  const auto seed = seed_of(shared, *scenario);
  if (!seed) return bad_input(kFidelityName, seed.error());
  const fs::path out = shared.out.empty() ? fs::path("out/fidelity") : fs::path(shared.out);
  auto folder = OutputFolder::create(out, shared.overwrite);
  if (!folder) return bad_input(kFidelityName, folder.error());
  watch_interrupt();
  const auto fidelity =
      fidelity_study(scenario_of_seed(*scenario, *seed), *walk_of_go1, *seed, kStandingTime,
                     observer_of(shared.quiet));
  if (interrupted()) return interrupted_code();
  if (!fidelity) return bad_input(kFidelityName, located(*scenario, fidelity.error()));
  auto written = write_fidelity(*fidelity, folder->path());
  if (written) written = folder->commit();
  if (!written) return bad_input(kFidelityName, written.error());
  print_fidelity(*fidelity);
  print_out("results: {}, imu.csv, allan.csv, ranges.csv, leg_drift.csv, stance.csv\n",
            (out / "fidelity.md").string());
  return kOk;
}

}  // namespace

void declare_fidelity(Command command, const fs::path& scenarios) {
  auto shared = std::make_shared<SharedOptions>();
  shared->folder = scenarios.string();
  add_scenario(command, *shared, Presence::kOptional);
  add_folder(command, *shared);
  add_seeds(command, *shared, "that of the scenario; one");
  add_settings(command, *shared);
  add_out(command, *shared, "out/fidelity");
  add_overwrite(command, *shared);
  add_quiet(command, *shared);
  command.footer(
      "Without a scenario: fidelity_walk. The stance is that of fidelity_go1_walk.\n"
      "Examples:\n"
      "  aims_lab fidelity\n"
      "  aims_lab fidelity --seeds 2 --set sensors=ideal --out out/fidelity-ideal");
  command.action([shared] { return fidelity_command(*shared); });
}

}  // namespace aims
