// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <string>
#include <vector>

#include "bench/estimate/estimate.hpp"
#include "bench/estimate/mount_check.hpp"
#include "cli/commands.hpp"
#include "cli/json_output.hpp"
#include "cli/options.hpp"
#include "cli/terminal.hpp"
#include "recordings/inspection/bag_check.hpp"
#include "recordings/inspection/bag_info.hpp"

namespace aims {
namespace {

namespace fs = std::filesystem;

struct BagArguments {
  SharedOptions shared;
  std::vector<std::string> files;
  std::string config;
  std::vector<std::string> systems;
  bool recover = false;
  bool mount = false;
  bool json = false;
};

Result<BagInfo> info_of(const BagArguments& arguments) {
  const auto& settings = arguments.shared.settings;
  if (auto read = check_settings(settings, {"recording"}, false); !read) {
    return tl::unexpected(read.error());
  }
  const auto config = load_estimate_config(arguments.config, settings);
  if (!config) return tl::unexpected(config.error());
  return bag_info(arguments.files.front(), config->recording,
                  {.recover = arguments.recover, .with = further(arguments.files)});
}

/// What the data say of the mount of the LiDAR, when asked for.
Result<std::vector<std::string>> mount_of(const BagArguments& arguments) {
  if (!arguments.mount) return std::vector<std::string>();
  const auto config = load_estimate_config(arguments.config, arguments.shared.settings);
  if (!config) return tl::unexpected(config.error());
  EstimateOptions options;
  options.bag = arguments.files.front();
  options.recover = arguments.recover;
  options.with = further(arguments.files);
  return mount_report(*config, options);
}

int info_command(const BagArguments& arguments) {
  const auto info = info_of(arguments);
  if (!info) return refuse("info", info.error(), arguments.json);
  const auto mount = mount_of(arguments);
  if (!mount) return refuse("info", mount.error(), arguments.json);
  if (arguments.json) {
    Json document = info_json(*info);
    if (arguments.mount) document["mount"] = *mount;
    print_json(document);
  } else {
    print_out("{}", info_text(*info));
    for (const std::string& line : *mount) print_out("{}\n", line);
  }
  return kOk;
}

/// The checks of those systems, or of all without any; error for one that is not known.
Result<std::vector<RequirementCheck>> checks_of(const std::vector<std::string>& systems,
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
    return failure(fmt::format("--system: unknown system '{}'; expected one of {}", system,
                               fmt::join(known, ", ")));
  }
  return wanted;
}

int check_command(const BagArguments& arguments) {
  const auto info = info_of(arguments);
  if (!info) return refuse("check", info.error(), arguments.json);
  const auto checks = checks_of(arguments.systems, check_bag(*info));
  if (!checks) return refuse("check", checks.error(), arguments.json);
  if (arguments.json) {
    print_json(check_json(info->file, *checks));
  } else {
    print_out("{}\n{}\n{}", info->file.string(), to_text(check_table(*checks)),
              check_text(*checks));
  }
  const bool missing = std::any_of(checks->begin(), checks->end(), [](const auto& each) {
    return each.fulfilment == Fulfilment::kMissing;
  });
  return missing && !arguments.systems.empty() ? kExpectationFailed : kOk;
}

std::shared_ptr<BagArguments> add_bag_options(Command& command) {
  auto arguments = std::make_shared<BagArguments>();
  command.arguments("bag", arguments->files, "Recording: files or folders, merged by record time",
                    Presence::kRequired);
  command.option("--config", arguments->config, "YAML file; its group recording is used");
  add_settings(command, arguments->shared, "the configuration, e.g. recording.topics.imu=/imu",
               kGroupSetting);
  command.flag("--recover", arguments->recover, "Read the intact part of a damaged bag");
  add_json(command, arguments->json);
  return arguments;
}

}  // namespace

void declare_info(Command command, const fs::path& /*scenarios*/) {
  auto arguments = add_bag_options(command);
  command.flag("--mount", arguments->mount,
               "Compare the rotation of LiDAR odometry (first 3 min) with\n"
               "the gyro: an inverted or turned extrinsic, an IMU upside down, a\n"
               "mirrored axis, a clock that is off, a gyro in deg/s");
  command.footer("Example:\n  aims info robot.bag --mount");
  command.action([arguments] { return info_command(*arguments); });
}

void declare_check(Command command, const fs::path& /*scenarios*/) {
  auto arguments = add_bag_options(command);
  command.list("--system", arguments->systems, "Only these systems, e.g. FAST-LIO2,LIO-SAM (all)");
  command.footer(
      "Example:\n"
      "  aims check robot.bag --system FAST-LIO2,LIO-SAM\n"
      "Exit codes: as of aims; 1 when a system of --system lacks an input.");
  command.action([arguments] { return check_command(*arguments); });
}

}  // namespace aims
