// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <string>
#include <string_view>
#include <vector>

#include "core/config.hpp"
#include "core/error.hpp"
#include "core/leg_geometry.hpp"
#include "sim/robot/gait.hpp"
#include "sim/robot/mounts.hpp"
#include "sim/robot/robot_geometry.hpp"

namespace aims {

/// Where a sensor sits on the trunk.
struct SensorMountConfig {
  Eigen::Vector3d translation = Eigen::Vector3d::Zero();       ///< in the trunk's frame [m]
  Eigen::Vector3d rotation_rpy_deg = Eigen::Vector3d::Zero();  ///< roll, pitch, yaw [deg]
};
void describe(Fields& f, SensorMountConfig& c);

/// Nominal mounts of the sensors.
struct SensorMountsConfig {
  SensorMountConfig imu = {.translation = {-0.17, 0.0, 0.02}};
  SensorMountConfig lidar = {.translation = {-0.14, 0.0, 0.18}};
};
void describe(Fields& f, SensorMountsConfig& c);

/// The robot, apart from the errors of its sensors. The defaults are those of the model
/// `quadruped`.
struct RobotConfig {
  std::string model = "quadruped";  ///< of models/; its figures lie below a scenario's own keys
  LegGeometry legs = kRobotGeometry;
  SensorMountsConfig mounts;
  double half_width = 0.16;  ///< with its feet, as far as a wall must be from a route [m]
  GaitConfig gait;
  double start_position_sigma = 0.02;  ///< of the start about the first point, per axis [m]
  double start_heading_sigma = 0.02;   ///< of the heading at the start [rad]
};
void describe(Fields& f, RobotConfig& c);

/// The mounts that the configuration states; no drawn error is part of them.
Mounts nominal_mounts(const SensorMountsConfig& mounts);

/// A robot's folder in models, part of the program.
struct RobotModel {
  std::string_view name;  ///< of the folder
  std::string_view text;  ///< robot.yaml
  /// The robot as an MJCF document of its own. Bodies: `trunk`, and per leg `FL_hip`, `FL_thigh`,
  /// `FL_calf`; sites: `imu`, `lidar`, `FL_foot`; geoms: `FL_foot`.
  std::string_view mjcf;
};

/// Every robot; the first is the default.
std::vector<RobotModel> robot_models();

/// The robot of that name. Error with the names that there are.
Result<RobotModel> robot_model(std::string_view name);

}  // namespace aims
