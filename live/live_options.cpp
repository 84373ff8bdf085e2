// SPDX-License-Identifier: BSD-3-Clause
#include "live/live_options.hpp"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cctype>

namespace aims {
namespace {

constexpr const char* kRos1Description =
    "Estimates a robot's motion live from ROS 1 topics and publishes it on ~odometry.";
constexpr const char* kDdsDescription =
    "Estimates a robot's motion live from ROS 2 topics and publishes it on /aims/odometry.\n"
    "Needs no ROS: it speaks DDS.";

constexpr const char* kRos1Footer =
    "Topics and the node are renamed as ROS does (/a:=/b, __name:=c).\n"
    "Exit codes: 0 ok, 2 bad usage, configuration or topics.";

constexpr const char* kDdsFooter =
    "CYCLONEDDS_URI chooses the interfaces. Exit codes: 0 ok, 2 bad usage, configuration or "
    "topics.";

/// What ROS 2 takes as a namespace: words of letters, digits and _, joined by /.
std::string is_node_name(const std::string& name) {
  const bool fits = std::ranges::all_of(
      name, [](unsigned char c) { return std::isalnum(c) != 0 || c == '_' || c == '/'; });
  const bool joined = !name.empty() && name.front() != '/' && name.back() != '/' &&
                      name.find("//") == std::string::npos &&
                      std::isdigit(static_cast<unsigned char>(name.front())) == 0;
  return fits && joined ? ""
                        : fmt::format("expected letters, digits and _, e.g. aims, got '{}'", name);
}

void add_options(CLI::App& app, LiveOptions& options) {
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
                 "Frame of the published poses (odom)");
  app.add_option("--body-frame,--body_frame", options.body_frame, "Frame of the IMU (imu)");
  app.add_flag("--tf", options.tf, "Also publish the pose on /tf");
  app.add_option("--settle", options.settle,
                 "Time [s] gathered before topics, units and extrinsics are decided (3)")
      ->check(CLI::Range(0.1, 60.0));
  app.add_option("--patience", options.patience,
                 "Timeout [s] without the needed topics; 0: none (0)")
      ->check(CLI::Range(0.0, 1e6));
  app.add_option("--max-wait,--max_wait", options.max_wait,
                 "A cloud that has waited longer [s] is dropped for a newer one (0.05)")
      ->check(CLI::Range(0.05, 20.0));
}

void add_dds_options(CLI::App& app, LiveOptions& options) {
  app.add_option("--domain", options.domain, "DDS domain ($ROS_DOMAIN_ID, else 0)")
      ->check(CLI::Range(0, 232));
  app.add_option("--node", options.node, "Namespace of the published topics (aims)")
      ->check(is_node_name);
  app.add_flag("--source-time,--source_time", options.source_time,
               "Arrivals are the publishers' times of sending: for aims_play at another pace");
  app.add_option("--tell", options.tell,
                 "Send a command to the running node of that name and end: save_map, calibrate "
                 "(standing), reset")
      ->check(CLI::IsMember({"save_map", "calibrate", "reset"}));
}

}  // namespace

Result<LiveCommand> parse_live_arguments(std::vector<std::string> arguments, LiveNetwork network) {
  LiveCommand command;
  const bool dds = network == LiveNetwork::kDds;
  CLI::App app(dds ? kDdsDescription : kRos1Description, dds ? "aims_live" : "aims_node");
  app.footer(dds ? kDdsFooter : kRos1Footer);
  add_options(app, command.options);
  if (dds) add_dds_options(app, command.options);
  std::ranges::reverse(arguments);  // the order that CLI11 expects
  try {
    app.parse(arguments);
  } catch (const CLI::CallForHelp&) {
    command.help = app.help();
  } catch (const CLI::ParseError& error) {
    return failure(fmt::format("{}; see --help", error.what()));
  }
  return command;
}

}  // namespace aims
