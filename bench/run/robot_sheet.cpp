// SPDX-License-Identifier: BSD-3-Clause
#include "bench/run/robot_sheet.hpp"

#include <fmt/format.h>

#include "bench/run/model_file.hpp"
#include "sim/robot/robot_config.hpp"

namespace aims {
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
