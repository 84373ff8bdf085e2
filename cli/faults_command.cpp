// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <string>
#include <vector>

#include "bench/jobs/sequence_cache.hpp"
#include "bench/scoring/validity.hpp"
#include "bench/studies/fault_study.hpp"
#include "cli/commands.hpp"
#include "cli/options.hpp"
#include "cli/progress.hpp"
#include "cli/terminal.hpp"
#include "core/files/output_folder.hpp"

namespace aims {
namespace {

namespace fs = std::filesystem;

constexpr const char* kFaultsName = "study faults";

struct FaultArguments {
  SharedOptions shared;
  std::vector<std::string> faults;
  bool list = false;
};

void print_list() {
  for (const StreamFault& fault : stream_faults()) {
    print_out("{:<28} {}\n", fault.name, fault.meaning);
  }
}

/// The scenario's sequence, from the cache or simulated now.
Result<Sequence> sequence_of(const Scenario& scenario, std::uint64_t seed, const fs::path& folder) {
  const SequenceCache cache(folder.empty() ? SequenceCache::default_folder() : folder);
  const std::string id = SequenceCache::id_of(scenario, seed);
  const auto made = cache.make(scenario, seed);
  if (!made) return tl::unexpected(made.error());
  if (made->refusal) return failure(*made->refusal);
  return open_sequence(cache.file_of(id), scenario, seed);
}

int faults_command(const FaultArguments& arguments) {
  if (arguments.list) {
    print_list();
    return kOk;
  }
  const SharedOptions& shared = arguments.shared;
  const auto scenario = scenario_of(shared);
  if (!scenario) return bad_input(kFaultsName, scenario.error());
  const auto seed = seed_of(shared, *scenario);
  if (!seed) return bad_input(kFaultsName, seed.error());
  const Scenario drawn = scenario_of_seed(*scenario, *seed);
  watch_interrupt();
  const fs::path out = shared.out.empty() ? fs::path("out/faults") : fs::path(shared.out);
  auto folder = OutputFolder::create(out, shared.overwrite);
  if (!folder) return bad_input(kFaultsName, folder.error());
  const auto sequence = sequence_of(drawn, *seed, shared.cache);
  if (!sequence) return bad_input(kFaultsName, sequence.error());
  if (const auto reason = invalid_reason(sequence->walk, to_seconds(sequence->end()))) {
    print_out("INVALID RUN: {} seed {}: {}; no fault is tried on it\n", scenario->name, *seed,
              *reason);
    return kInvalidRun;
  }
  if (interrupted()) return interrupted_code();
  const FaultStudyOptions options = {scenario->run, arguments.faults, *seed, shared.jobs};
  const auto cases = fault_study(*sequence, drawn, options, [&](std::size_t done, std::size_t all) {
    if (!shared.quiet && done % 10 == 0) print_error(fmt::format("{} of {} cases", done, all));
    return !interrupted();
  });
  if (!cases) return bad_input(kFaultsName, cases.error());
  const std::string name = fmt::format("{}, seed {}", scenario->name, *seed);
  if (auto ok = write_faults(*cases, name, folder->path()); !ok) {
    return bad_input(kFaultsName, ok.error());
  }
  if (auto ok = folder->commit(); !ok) return bad_input(kFaultsName, ok.error());
  print_out("{}: ATE [m] and the worst state reported; SILENT: failed and called healthy\n{}\n",
            name, to_text(fault_table(*cases)));
  print_out("results: {}, faults.csv\n", (out / "faults.md").string());
  if (interrupted()) return interrupted_code();
  return std::ranges::any_of(*cases, &FaultCase::silent) ? kExpectationFailed : kOk;
}

}  // namespace

void declare_faults(Command command, const fs::path& scenarios) {
  auto arguments = std::make_shared<FaultArguments>();
  SharedOptions& shared = arguments->shared;
  shared.folder = scenarios.string();
  add_scenario(command, shared, Presence::kOptional);
  add_folder(command, shared);
  add_seeds(command, shared, "that of the scenario; one");
  add_robot_seed(command, shared);
  add_estimators(command, shared, "those of the scenario");
  add_settings(command, shared);
  add_out(command, shared, "out/faults");
  add_overwrite(command, shared);
  command.option("--cache", shared.cache, "Folder of simulated sequences");
  add_jobs(command, shared);
  add_quiet(command, shared);
  command.list("--faults", arguments->faults, "Names or beginnings of names, e.g. imu.dead,lidar");
  command.flag("--list", arguments->list, "List the faults");
  command.footer(
      "Exit code 1 when an estimator fails without noticing.\n"
      "Examples:\n"
      "  aims study faults corridor --estimators aims_d,lio\n"
      "  aims study faults corridor --faults imu,lidar.yaw --out out/imu-faults");
  command.action([arguments] { return faults_command(*arguments); });
}

}  // namespace aims
