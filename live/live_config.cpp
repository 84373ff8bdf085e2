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

namespace {

std::string is_frame(const std::string& name) { return name.empty() ? "expected a name" : ""; }

}  // namespace

void add_live_options(CLI::App& app, LiveOptions& options) {
  app.add_option("--estimator,--estimators", options.estimator, "Estimator to run (aims_d)");
  app.add_option(
      "--robot", options.robot,
      "Topics of a robot: simulated, anymal, go2, ouster, livox, or a YAML file like theirs");
  app.add_option("--config", options.config, "YAML file with recording, estimator");
  app.add_option("--calibration", options.calibration,
                 "Calibration of the robot, a file of `aims calibrate`:\n"
                 "a prior that the data can overrule (none)");
  app.add_option("--set", options.overrides, "key=value, applied after the file; repeatable")
      ->expected(1)
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
  app.add_option("--out", options.out,
                 "Folder for trajectory, health, counts and map, as they come");
  app.add_option("--record", options.record,
                 "Recording to write of the messages read: .mcap under ROS 2, .bag under ROS 1");
  app.add_option("--odom-frame,--odom_frame", options.odom_frame,
                 "Frame of the published poses (odom)")
      ->check(is_frame);
  app.add_option("--body-frame,--body_frame", options.body_frame, "Frame of the IMU (imu)")
      ->check(is_frame);
  app.add_flag("--tf", options.tf, "Also publish the pose on /tf");
  app.add_option(
         "--settle", options.settle,
         "Time [s] for which each topic must have come before topics and units are decided (3)")
      ->check(CLI::Range(0.1, 60.0));
  app.add_option("--patience", options.patience,
                 "Timeout [s] without the needed topics; 0: none (0)")
      ->check(CLI::Range(0.0, 1e6));
  app.add_option("--max-wait,--max_wait", options.max_wait,
                 "A cloud that has waited longer [s] is dropped for a newer one (0.05)")
      ->check(CLI::Range(0.05, 20.0));
}

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
