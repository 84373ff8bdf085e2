// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>

#include <memory>

#include "bench/cli/commands.hpp"
#include "bench/cli/options.hpp"
#include "bench/run/scenario.hpp"

namespace aims {
namespace {

int config_command(const SharedOptions& shared, bool plain) {
  const auto scenario =
      shared.scenario.empty() ? default_scenario(shared.settings) : scenario_of(shared);
  if (!scenario) return bad_input("config", scenario.error());
  fmt::print("{}", config_text(*scenario, !plain));
  return kOk;
}

}  // namespace

void declare_config(Command command, const std::filesystem::path& scenarios) {
  struct Arguments {
    SharedOptions shared;
    bool plain = false;
  };
  auto arguments = std::make_shared<Arguments>();
  arguments->shared.folder = scenarios.string();
  add_scenario(command, arguments->shared, Presence::kOptional);
  add_folder(command, arguments->shared);
  add_settings(command, arguments->shared);
  command.flag("--plain", arguments->plain, "Values without comments");
  command.footer(
      "Without a scenario, the defaults. The output is a scenario file.\n"
      "Example:\n"
      "  aims config corridor --set lidar.range_max=30");
  command.action([arguments] { return config_command(arguments->shared, arguments->plain); });
}

}  // namespace aims
