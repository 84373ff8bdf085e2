// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <map>
#include <string>
#include <vector>

#include "core/error.hpp"

namespace aims {

/// Options of the node. Each is an option of the command line or a private parameter of that name;
/// the command line takes precedence.
struct NodeOptions {
  std::string estimator = "aims_d";
  std::string config;                  ///< YAML file with `recording` and `estimator`
  std::vector<std::string> overrides;  ///< key=value, applied after the file
  std::string out;                     ///< TUM file written at the end; empty: none
  std::string odom_frame = "odom";     ///< of the published poses
  std::string body_frame = "imu";      ///< child frame: the IMU's
  bool tf = false;                     ///< also publish odom_frame -> body_frame on /tf
  double settle = 3.0;    ///< time gathered before topics, units and extrinsics are decided [s]
  double patience = 0.0;  ///< timeout without the needed topics [s]; 0: none
};

/// Parsed arguments.
struct NodeCommand {
  NodeOptions options;
  std::vector<std::string> given;  ///< names of the options in the command line
  std::string help;                ///< not empty: print it and exit
};

/// Parses arguments without ROS's own. Error: one line.
Result<NodeCommand> parse_node_arguments(std::vector<std::string> arguments);

/// Applies private parameters: "estimator", "config", ... and "set/a/b" for the setting a.b. Error
/// for an unknown one, with a near match.
Result<void> apply_parameters(const std::map<std::string, std::string>& parameters,
                              NodeCommand& command);

}  // namespace aims
