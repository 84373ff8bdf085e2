// SPDX-License-Identifier: BSD-3-Clause
#include "live/live_config.hpp"

#include <fmt/format.h>

#include <set>
#include <system_error>
#include <utility>
#include <vector>

#include "core/files/yaml_config.hpp"
#include "estimator/estimator_spec.hpp"
#include "recordings/frames/configured_extrinsic.hpp"

namespace aims {

namespace fs = std::filesystem;

void describe(Fields& fields, LiveConfig& config) {
  fields.group("recording", config.recording);
  describe_estimators(fields, {config.estimator}, config.estimators);
}

Result<std::filesystem::path> find_robot(const std::string& robot, const fs::path& program) {
  if (robot.ends_with(".yaml")) return fs::path(robot);
  std::set<std::string> known;
  for (fs::path folder = program.parent_path(); folder.has_relative_path();
       folder = folder.parent_path()) {
    for (const char* candidate : {"share/aims-live/robots", "live/robots"}) {
      std::error_code none;
      for (const auto& entry : fs::directory_iterator(folder / candidate, none)) {
        if (entry.path().extension() != ".yaml") continue;
        if (entry.path().stem() == robot) return entry.path();
        known.insert(entry.path().stem().string());
      }
    }
  }
  return failure(fmt::format("robot '{}' is unknown: expected {}{}a .yaml file", robot,
                             fmt::join(known, ", "), known.empty() ? "" : " or "));
}

Result<LiveConfig> load_live_config(const LiveOptions& options) {
  LiveConfig config;
  if (auto spec = parse_estimator_spec(options.estimator); !spec) {
    return tl::unexpected(spec.error());
  }
  if (options.odom_frame == options.body_frame) {
    return failure(fmt::format("--body-frame: expected another frame than --odom-frame, '{}'",
                               options.odom_frame));
  }
  config.estimator = options.estimator;
  std::vector<AssignedKey> assigned;
  if (!options.robot.empty()) {
    const auto file = find_robot(options.robot, std::filesystem::read_symlink("/proc/self/exe"));
    if (!file) return tl::unexpected(file.error());
    if (auto ok = load_config(*file, config); !ok) return tl::unexpected(ok.error());
  }
  if (!options.config.empty()) {
    auto ok = load_config(options.config, config, &assigned);
    if (!ok) return tl::unexpected(ok.error());
    find_calibrations(config.recording, std::filesystem::path(options.config).parent_path());
  }
  std::vector<std::string> overrides;
  if (!options.calibration.empty()) {
    auto calibration = read_robot_calibration(options.calibration);
    if (!calibration) return failure("--calibration " + calibration.error().message);
    overrides = prior_settings(*calibration, options.calibration);
    config.calibration = std::move(*calibration);
  }
  overrides.insert(overrides.end(), options.overrides.begin(), options.overrides.end());
  if (auto ok = apply_overrides(config, overrides, &assigned); !ok) {
    return tl::unexpected(ok.error());
  }
  const std::vector<std::string> run = {config.estimator};
  auto acts = check_effects(fields_of(config), std::move(assigned), true, run, config.estimators);
  if (!acts) return tl::unexpected(acts.error());
  config.recording.topics.truth = "none";  // for scoring alone
  return config;
}

}  // namespace aims
