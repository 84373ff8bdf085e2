// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "core/error.hpp"

namespace aims {

/// Options of the node. Each is an option of the command line or a private parameter of that name;
/// the command line takes precedence.
struct LiveOptions {
  std::string estimator = "aims_d";
  std::string robot;                   ///< name of a robot's file, or its path; empty: none
  std::string config;                  ///< YAML file with `recording` and `estimator`
  std::string calibration;             ///< of the robot, a file of `aims calibrate`; empty: none
  std::vector<std::string> overrides;  ///< key=value, applied after the file
  std::string out;                  ///< folder of trajectory, health, counts and map; empty: none
  std::string record;               ///< recording of the messages read; empty: none
  std::string odom_frame = "odom";  ///< of the published poses
  std::string body_frame = "imu";   ///< child frame: the IMU's
  bool tf = false;                  ///< also publish odom_frame -> body_frame on /tf
  double settle = 3.0;    ///< time gathered before topics, units and extrinsics are decided [s]
  double patience = 0.0;  ///< timeout without the needed topics [s]; 0: none
  double max_wait = 0.2;  ///< a cloud that has waited longer for the estimator is dropped [s]
  // Of DDS alone.
  std::optional<std::uint32_t> domain;  ///< none: $ROS_DOMAIN_ID, or 0
  std::string node = "aims";            ///< namespace of the published topics
  bool source_time = false;             ///< arrivals are the publishers' times of sending
  std::string tell;                     ///< command to send to a running node; empty: estimate
};

enum class LiveNetwork { kRos1, kDds };

/// Parsed arguments.
struct LiveCommand {
  LiveOptions options;
  std::vector<std::string> given;  ///< names of the options in the command line
  std::string help;                ///< not empty: print it and exit
};

/// Parses arguments without ROS's own. Error: one line.
Result<LiveCommand> parse_live_arguments(std::vector<std::string> arguments, LiveNetwork network);

/// Applies private parameters: "estimator", "config", ... and "set/a/b" for the setting a.b. Error
/// for an unknown one, with a near match.
Result<void> apply_parameters(const std::map<std::string, std::string>& parameters,
                              LiveCommand& command);

}  // namespace aims
