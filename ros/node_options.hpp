// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <map>
#include <string>
#include <vector>

#include "core/error.hpp"

namespace aims {

/// How the node runs. Each is an option of the command line or a private parameter of that name;
/// the command line wins.
struct NodeOptions {
  std::string estimator = "aims";
  std::string config;                  ///< YAML file, as of `aims estimate`
  std::vector<std::string> overrides;  ///< key=value on top
  std::string out;                     ///< TUM file written at the end; empty: none
  std::string odom_frame = "odom";     ///< of the published poses
  std::string body_frame = "imu";      ///< child frame: the IMU's
  bool tf = false;                     ///< also publish odom_frame -> body_frame on /tf
  double settle = 3.0;    ///< gathered before topics, units and extrinsics are decided [s]
  double patience = 0.0;  ///< given up after so long without what is needed [s]; 0: never
};

/// What the arguments ask for.
struct NodeCommand {
  NodeOptions options;
  std::vector<std::string> given;  ///< names of the options that the command line states
  std::string help;                ///< not empty: print it and do nothing
};

/// Parses arguments without ROS's own. Error: one line.
Result<NodeCommand> parse_node_arguments(std::vector<std::string> arguments);

/// Fills in private parameters: "estimator", "config", ... and "set/a/b" for the setting a.b. Error
/// for an unknown one, with a near match.
Result<void> apply_parameters(const std::map<std::string, std::string>& parameters,
                              NodeCommand& command);

}  // namespace aims
