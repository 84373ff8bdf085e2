// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "core/config.hpp"
#include "core/error.hpp"
#include "estimator/registry.hpp"
#include "estimator/robot_calibration.hpp"
#include "live/live_options.hpp"
#include "recordings/recording_config.hpp"

namespace aims {

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
