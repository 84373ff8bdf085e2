// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>

#include <memory>

#include "bench/scenario/seeds.hpp"
#include "cli/options.hpp"
#include "cli/progress.hpp"
#include "cli/terminal.hpp"
#include "lab/commands.hpp"
#include "lab/weak/weak_direction.hpp"

namespace aims {
namespace {

namespace fs = std::filesystem;

constexpr const char* kWeakName = "weak";

int weak_command(const SharedOptions& shared) {
  const auto scenarios = scenarios_of(shared);
  if (!scenarios) return bad_input(kWeakName, scenarios.error());
  const auto seeds = seeds_of(shared, {1});
  if (!seeds) return bad_input(kWeakName, seeds.error());
  std::vector<WeakDirection> runs;
  for (const ScenarioFile& each : *scenarios) {
    if (!each.scenario) return bad_input(kWeakName, each.scenario.error());
  }
  for (const ScenarioFile& each : *scenarios) {
    for (const std::uint64_t seed : *seeds) {
      if (!shared.quiet) print_error(fmt::format("{} seed {}", each.scenario->name, seed));
      const auto run = weak_direction(*each.scenario, seed, shared.cache, [](double) {});
      if (!run) return bad_input(kWeakName, located(*each.scenario, run.error()));
      runs.push_back(*run);
    }
  }
  const fs::path out = shared.out.empty() ? fs::path("out/weak") : fs::path(shared.out);
  if (auto written = write_weak_direction(runs, out); !written) {
    return bad_input(kWeakName, written.error());
  }
  print_out("Equivalent returns along the weak axis, by source\n{}\nresults: {}, weak.csv\n",
            to_text(weak_direction_table(runs)), (out / "weak.md").string());
  return kOk;
}

}  // namespace

void declare_weak(Command command, const fs::path& scenarios) {
  auto shared = std::make_shared<SharedOptions>();
  shared->folder = scenarios.string();
  add_named_scenarios(command, *shared);
  add_folder(command, *shared);
  add_seeds(command, *shared, "1");
  add_settings(command, *shared);
  add_cache(command, *shared);
  add_out(command, *shared, "out/weak");
  add_quiet(command, *shared);
  command.footer(
      "Example:\n  aims_lab weak severity_8 severity_9 severity_9_relief --seeds 301-303");
  command.action([shared] { return weak_command(*shared); });
}

}  // namespace aims
