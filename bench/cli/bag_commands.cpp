// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <string>
#include <vector>

#include "bench/cli/commands.hpp"
#include "bench/cli/exit_code.hpp"
#include "bench/cli/options.hpp"
#include "bench/run/estimate.hpp"
#include "recordings/inspection/bag_check.hpp"
#include "recordings/inspection/bag_info.hpp"

namespace aims {
namespace {

struct BagArguments {
  std::string bag;
  std::string config;
  std::vector<std::string> overrides;
  std::vector<std::string> systems;
  bool recover = false;
};

Result<BagInfo> info_of(const BagArguments& arguments) {
  const auto config = load_estimate_config(arguments.config, arguments.overrides);
  if (!config) return tl::unexpected(config.error());
  return bag_info(arguments.bag, config->recording, {arguments.recover});
}

int info_command(const BagArguments& arguments) {
  const auto info = info_of(arguments);
  if (!info) return bad_input("info", info.error());
  fmt::print("{}", info_text(*info));
  return kOk;
}

/// The checks of the systems asked for; error for a system that is not known.
Result<std::vector<RequirementCheck>> checks_for(const std::vector<std::string>& systems,
                                                 std::vector<RequirementCheck> all) {
  if (systems.empty()) return all;
  std::vector<RequirementCheck> wanted;
  for (const std::string& system : systems) {
    const std::size_t before = wanted.size();
    std::copy_if(all.begin(), all.end(), std::back_inserter(wanted),
                 [&system](const RequirementCheck& each) { return each.system == system; });
    if (wanted.size() > before) continue;
    std::vector<std::string> known;
    for (const RequirementCheck& each : all) {
      if (known.empty() || known.back() != each.system) known.push_back(each.system);
    }
    return failure(fmt::format("--for: unknown system '{}'; expected one of {}", system,
                               fmt::join(known, ", ")));
  }
  return wanted;
}

int check_command(const BagArguments& arguments) {
  const auto info = info_of(arguments);
  if (!info) return bad_input("check", info.error());
  const auto checks = checks_for(arguments.systems, check_bag(*info));
  if (!checks) return bad_input("check", checks.error());
  fmt::print("{}\n{}\n{}", info->file.string(), to_text(check_table(*checks)), check_text(*checks));
  const bool missing = std::any_of(checks->begin(), checks->end(), [](const auto& each) {
    return each.fulfilment == Fulfilment::kMissing;
  });
  return missing && !arguments.systems.empty() ? kGateFailed : kOk;
}

CLI::App* add_bag_command(CLI::App& app, const char* name, const char* meaning,
                          const std::shared_ptr<BagArguments>& arguments) {
  auto* command = app.add_subcommand(name, meaning);
  command->add_option("bag", arguments->bag, "ROS 1 bag")->required();
  command->add_option("--config", arguments->config, "YAML file as for aims estimate");
  add_repeatable(*command, "--set", arguments->overrides,
                 "key=value on top, e.g. recording.topics.imu=/i");
  command->add_flag("--recover", arguments->recover, "Read what is whole in a broken bag");
  return command;
}

}  // namespace

void add_info_command(CLI::App& app, int& exit_code) {
  auto arguments = std::make_shared<BagArguments>();
  auto* command = add_bag_command(
      app, "info", "Topics, rates, gaps, offsets, noise and extrinsics of a bag", arguments);
  command->callback([arguments, &exit_code] { exit_code = info_command(*arguments); });
}

void add_check_command(CLI::App& app, int& exit_code) {
  auto arguments = std::make_shared<BagArguments>();
  auto* command =
      add_bag_command(app, "check", "Which systems a bag has all the inputs for", arguments);
  command
      ->add_option("--for", arguments->systems,
                   "Only these, e.g. FAST-LIO2,LIO-SAM; exit code 1 when one cannot run")
      ->delimiter(',');
  command->callback([arguments, &exit_code] { exit_code = check_command(*arguments); });
}

}  // namespace aims
