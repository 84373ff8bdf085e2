// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <CLI/CLI.hpp>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "core/config.hpp"
#include "core/error.hpp"
#include "estimator/registry.hpp"
#include "estimator/robot_calibration.hpp"
#include "recordings/recording_config.hpp"

namespace aims {

/// Options of a live estimate.
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
  double settle = 3.0;              ///< for which each topic must have come before it decides [s]
  double patience = 0.0;            ///< timeout without the needed topics [s]; 0: none
  double max_wait = 0.05;    ///< a cloud that has waited longer is dropped for a newer one [s]
  bool source_time = false;  ///< arrivals are the publishers' times of sending; DDS alone
};

/// Declares the options of every network.
void add_live_options(CLI::App& app, LiveOptions& options);

/// The groups of `aims estimate` that apply to a live estimate. The same file serves both, if it
/// has no other groups.
struct LiveConfig {
  RecordingConfig recording;
  EstimatorConfigs estimators;
  std::string estimator = "aims";               ///< spec of who estimates; from the options
  std::optional<RobotCalibration> calibration;  ///< from the options
};

void describe(Fields& fields, LiveConfig& config);

/// The file of a robot: the path itself, or NAME.yaml in share/aims-live/robots or live/robots of a
/// folder above `program`. Error, with the names there are, for an unknown one.
Result<std::filesystem::path> find_robot(const std::string& robot,
                                         const std::filesystem::path& program);

/// Reads the robot's file, then the options' file and applies their calibration and settings on
/// top. Error for an unknown estimator too.
Result<LiveConfig> load_live_config(const LiveOptions& options);

}  // namespace aims
