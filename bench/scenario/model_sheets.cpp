// SPDX-License-Identifier: BSD-3-Clause
#include "bench/scenario/model_sheets.hpp"

#include <fmt/format.h>
#include <algorithm>

#include "sim/robot/robot_config.hpp"
#include "sim/sensors/scan_pattern.hpp"

namespace aims {

namespace {

std::string mode_error(std::string_view key, const LidarConfig& config,
                       const std::vector<double>& modes, double got) {
  return fmt::format("lidar.{}: expected one of {} of {}, got {}", key, fmt::join(modes, ", "),
                     config.model, got);
}

bool offers(const std::vector<double>& modes, double value) {
  return modes.empty() || std::ranges::find(modes, value) != modes.end();
}

}  // namespace

void describe(Fields& f, LidarSheet& s) {
  f.text("description", s.description, {.meaning = "maker and model"});
  f.numbers("rates", s.rates,
            {.unit = "Hz", .range = up_to(1e3), .meaning = "scans per second to choose from"});
  f.numbers("columns", s.columns,
            {.unit = "-", .range = up_to(1e5), .meaning = "columns per scan to choose from"});
  f.text("imu", s.imu, {.meaning = "built-in IMU"});
  f.number("imu_rate", s.imu_rate,
           {.unit = "Hz", .range = up_to(1e4), .meaning = "of the built-in IMU"});
}

Result<LidarSheet> apply_lidar_model(std::string_view model, SensorLevel level,
                                     LidarConfig& config) {
  const std::vector<LidarModel> models = lidar_models();
  const auto found = std::ranges::find(models, model, &LidarModel::name);
  if (found == models.end()) return failure(fmt::format("lidar.model: no model '{}'", model));
  const std::string file = fmt::format("models/lidars/{}.yaml", model);
  return apply_model_file<LidarSheet>(found->text, file, level, config);
}

Result<void> check_lidar_mode(const LidarSheet& sheet, const LidarConfig& config) {
  if (!offers(sheet.rates, config.rate)) {
    return failure(mode_error("rate", config, sheet.rates, config.rate));
  }
  if (!offers(sheet.columns, config.columns)) {
    return failure(mode_error("columns", config, sheet.columns, config.columns));
  }
  return {};
}

double points_per_second(const LidarConfig& config) {
  const ScanPattern pattern(config);
  return 1e9 * pattern.lines() / pattern.column_period_ns();
}

std::string lidar_summary(const LidarSheet& sheet, const LidarConfig& config) {
  const ScanPattern pattern(config);
  const std::string imu =
      sheet.imu.empty() ? "" : fmt::format(", IMU {} at {:g} Hz", sheet.imu, sheet.imu_rate);
  return fmt::format("{}: {} {}, {:.0f} k points/s, {:g} to {:g} m{}", sheet.description,
                     pattern.lines(), pattern.has_rings() ? "rings" : "lines of a rosette",
                     1e-3 * points_per_second(config), config.range_min, config.range_max, imu);
}

void describe(Fields& f, RobotSheet& s) {
  f.text("description", s.description, {.meaning = "class and place of the LiDAR"});
  f.number("mass", s.mass, {.unit = "kg", .range = positive_up_to(1e3), .meaning = "in all"});
}

Result<RobotSheet> apply_robot_model(std::string_view model, SensorLevel level,
                                     SimulationConfig& config) {
  const auto found = robot_model(model);
  if (!found) return tl::unexpected(found.error());
  const std::string file = fmt::format("models/{}/robot.yaml", model);
  return apply_model_file<RobotSheet>(found->text, file, level, config);
}

std::string robot_summary(const RobotSheet& sheet, const SimulationConfig& config) {
  const LegGeometry& legs = config.robot.legs;
  return fmt::format("{}: {:g} kg, legs of {:g} + {:g} m, trunk at {:g} m", sheet.description,
                     sheet.mass, legs.thigh, legs.calf, config.robot.gait.body_height);
}

}  // namespace aims
