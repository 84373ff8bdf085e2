// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>

#include <memory>
#include <string>
#include <vector>

#include "bench/cli/commands.hpp"
#include "bench/cli/exit_code.hpp"
#include "bench/cli/options.hpp"
#include "bench/run/scenario.hpp"

namespace aims {
namespace {

struct ConfigArguments {
  std::string scenario;
  std::vector<std::string> overrides;
  bool plain = false;
};

Result<Scenario> scenario_of(const ConfigArguments& arguments,
                             const std::filesystem::path& folder) {
  if (arguments.scenario.empty()) return default_scenario(arguments.overrides);
  const auto file = find_scenario(arguments.scenario, folder);
  if (!file) return tl::unexpected(file.error());
  return load_scenario(*file, arguments.overrides);
}

int print_config(const ConfigArguments& arguments, const std::filesystem::path& folder) {
  const auto scenario = scenario_of(arguments, folder);
  if (!scenario) {
    fmt::print(stderr, "aims config: {}\n", scenario.error().message);
    return kBadInput;
  }
  fmt::print("{}", config_text(*scenario, !arguments.plain));
  return kOk;
}

}  // namespace

void add_config_command(CLI::App& app, const std::filesystem::path& scenario_folder,
                        int& exit_code) {
  auto* command = app.add_subcommand(
      "config", "Every parameter with its value, unit, range, meaning and source");
  auto arguments = std::make_shared<ConfigArguments>();
  command->add_option("scenario", arguments->scenario,
                      "Scenario file or name; the defaults alone when absent");
  add_repeatable(*command, "--set", arguments->overrides, "key=value on top of the scenario");
  command->add_flag("--plain", arguments->plain, "Values only: a YAML file that loads as it is");
  command->footer("Example: aims config corridor --set lidar.range_max=30");
  command->callback([arguments, scenario_folder, &exit_code] {
    exit_code = print_config(*arguments, scenario_folder);
  });
}

}  // namespace aims
