// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "core/config.hpp"
#include "core/error.hpp"
#include "core/files/yaml_config.hpp"
#include "sim/sensors/lidar_config.hpp"
#include "sim/sensors/sensor_level.hpp"
#include "sim/simulation_config.hpp"

namespace aims {

/// A file of models: what it states of the part (`sheet`), and what each level adds to the one
/// before. A level that is not wanted goes nowhere.
template <class Sheet, class Config>
struct ModelFile {
  Sheet& sheet;
  Config& ideal;
  Config& datasheet;
  Config& field;
};

template <class Sheet, class Config>
void describe(Fields& f, ModelFile<Sheet, Config>& file) {
  f.group("sheet", file.sheet);
  f.group("ideal", file.ideal);
  f.group("datasheet", file.datasheet);
  f.group("field", file.field);
}

/// Sets the keys of `config` that the file gives at that level, and returns its sheet. Errors name
/// the file as `name`.
template <class Sheet, class Config>
Result<Sheet> apply_model_file(std::string_view text, const std::string& name, SensorLevel level,
                               Config& config) {
  Sheet sheet;
  Config unused;
  ModelFile<Sheet, Config> file{sheet, config, level == SensorLevel::kIdeal ? unused : config,
                                level == SensorLevel::kField ? config : unused};
  if (auto ok = load_config_text(text, name, file); !ok) return tl::unexpected(ok.error());
  return sheet;
}

/// What a file of models/lidars states of the sensor, apart from the keys of the group `lidar`.
struct LidarSheet {
  std::string description;      ///< one line
  std::vector<double> rates;    ///< scans per second that it can be set to [Hz]; empty: any
  std::vector<double> columns;  ///< per scan, that it can be set to; empty: any
  std::string imu;              ///< part of the built-in IMU; empty: none
  double imu_rate = 0.0;        ///< of the built-in IMU [Hz]
};

void describe(Fields& fields, LidarSheet& sheet);

/// Sets the keys of `config` that the model's file gives at that level, and returns its sheet.
/// Error for a model that there is not, or for a file that cannot be read.
Result<LidarSheet> apply_lidar_model(std::string_view model, SensorLevel level,
                                     LidarConfig& config);

/// Error for a rate or a number of columns that the sensor of the sheet cannot be set to.
Result<void> check_lidar_mode(const LidarSheet& sheet, const LidarConfig& config);

/// Firings of all lines per second.
double points_per_second(const LidarConfig& config);

/// One line on what a model fires, for listings.
std::string lidar_summary(const LidarSheet& sheet, const LidarConfig& config);

/// What a robot.yaml in models states of the robot, apart from the keys of a scenario.
struct RobotSheet {
  std::string description;  ///< one line
  double mass = 0.0;        ///< [kg]
};

void describe(Fields& fields, RobotSheet& sheet);

/// Sets the keys of `config` that the robot's file gives at that level, and returns its sheet.
/// Error for a robot that there is not, or for a file that cannot be read.
Result<RobotSheet> apply_robot_model(std::string_view model, SensorLevel level,
                                     SimulationConfig& config);

/// One line on a robot, for listings.
std::string robot_summary(const RobotSheet& sheet, const SimulationConfig& config);

}  // namespace aims
