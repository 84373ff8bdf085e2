// SPDX-License-Identifier: BSD-3-Clause
#include "bench/run/robot_sheet.hpp"

#include <fmt/format.h>

#include "core/files/yaml_config.hpp"
#include "sim/robot/robot_config.hpp"

namespace aims {
namespace {

/// A robot.yaml: its sheet, and what each level adds. A level that is not wanted goes nowhere.
struct RobotModelFile {
  RobotSheet& sheet;
  SimulationConfig& ideal;
  SimulationConfig& datasheet;
  SimulationConfig& field;
};

void describe(Fields& f, RobotModelFile& file) {
  f.group("sheet", file.sheet);
  f.group("ideal", file.ideal);
  f.group("datasheet", file.datasheet);
  f.group("field", file.field);
}

}  // namespace

void describe(Fields& f, RobotSheet& s) {
  f.text("description", s.description, {.meaning = "class and place of the LiDAR"});
  f.number("mass", s.mass, {.unit = "kg", .range = positive_up_to(1e3), .meaning = "in all"});
}

Result<RobotSheet> apply_robot_model(std::string_view model, SensorLevel level,
                                     SimulationConfig& config) {
  const auto found = robot_model(model);
  if (!found) return tl::unexpected(found.error());
  RobotSheet sheet;
  SimulationConfig unused;
  RobotModelFile file{sheet, config, level == SensorLevel::kIdeal ? unused : config,
                      level == SensorLevel::kField ? config : unused};
  auto ok = load_config_text(found->text, fmt::format("models/{}/robot.yaml", model), file);
  if (!ok) return tl::unexpected(ok.error());
  return sheet;
}

std::string robot_summary(const RobotSheet& sheet, const SimulationConfig& config) {
  const LegGeometry& legs = config.robot.legs;
  return fmt::format("{}: {:g} kg, legs of {:g} + {:g} m, trunk at {:g} m", sheet.description,
                     sheet.mass, legs.thigh, legs.calf, config.robot.gait.body_height);
}

}  // namespace aims
