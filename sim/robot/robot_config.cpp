// SPDX-License-Identifier: BSD-3-Clause
#include "sim/robot/robot_config.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "core/angle.hpp"

namespace aims {
namespace {

Pose pose_of(const SensorMountConfig& mount) {
  const Eigen::Vector3d rpy = kRadiansPerDegree * mount.rotation_rpy_deg;
  const Eigen::Quaterniond roll(Eigen::AngleAxisd(rpy.x(), Eigen::Vector3d::UnitX()));
  const Eigen::Quaterniond pitch(Eigen::AngleAxisd(rpy.y(), Eigen::Vector3d::UnitY()));
  return {yaw_rotation(rpy.z()) * pitch * roll, mount.translation};
}

std::vector<std::string> model_names() {
  std::vector<std::string> names;
  for (const RobotModel& each : robot_models()) names.emplace_back(each.name);
  return names;
}

}  // namespace

void describe(Fields& f, SensorMountConfig& c) {
  f.vector("translation", c.translation,
           {.unit = "m", .range = within(5.0), .meaning = "Position in the trunk's frame."});
  f.vector("rotation_rpy_deg", c.rotation_rpy_deg,
           {.unit = "deg",
            .range = within(360.0),
            .meaning = "Roll, pitch and yaw in the trunk's frame."});
}

void describe(Fields& f, SensorMountsConfig& c) {
  f.group("imu", c.imu);
  f.group("lidar", c.lidar);
}

void describe(Fields& f, RobotConfig& c) {
  std::vector<std::pair<std::string, std::string>> models;
  for (const std::string& name : model_names()) models.emplace_back(name, name);
  f.choice("model", c.model, models,
           {.meaning = "Robot whose figures lie below the other keys.",
            .source = "models/NAME/robot.yaml"});
  f.group("legs", c.legs);
  f.group("mounts", c.mounts);
  f.number("half_width", c.half_width,
           {.unit = "m",
            .range = in_range(0.05, 1.0),
            .meaning = "Half of the width with feet: as far as walls must be from a route."});
  f.number("start_position_sigma", c.start_position_sigma,
           {.unit = "m",
            .range = in_range(0.0, 0.05),
            .meaning = "Standard deviation per axis of the start position about the first point."});
  f.number("start_heading_sigma", c.start_heading_sigma,
           {.unit = "rad",
            .range = in_range(0.0, 0.1),
            .meaning = "Standard deviation of the heading at the start."});
  f.group("gait", c.gait);
}

Mounts nominal_mounts(const SensorMountsConfig& mounts) {
  const Pose T_base_body = pose_of(mounts.imu);
  return {T_base_body, T_base_body.inverse() * pose_of(mounts.lidar)};
}

Result<RobotModel> robot_model(std::string_view name) {
  const std::vector<RobotModel> models = robot_models();
  const auto found = std::ranges::find(models, name, &RobotModel::name);
  if (found != models.end()) return *found;
  return failure(fmt::format("robot.model: expected one of {}, got '{}'",
                             fmt::join(model_names(), ", "), name));
}

}  // namespace aims
