// SPDX-License-Identifier: BSD-3-Clause
#include "recordings/csv/csv_mapping.hpp"

#include <fmt/format.h>

#include <array>

#include "core/files/yaml_config.hpp"

namespace aims {
namespace {

Spec columns_of(std::string meaning) {
  return {.unit = "-", .meaning = "columns of " + std::move(meaning) + "; empty: none"};
}

struct ColumnList {
  const char* key;
  const std::vector<std::string>& columns;
  std::size_t expected;
};

}  // namespace

void describe(Fields& f, CsvMapping& c) {
  f.text("file", c.file, {.unit = "-", .meaning = "table of comma-separated values, beside this"});
  f.text("time", c.time, {.unit = "-", .meaning = "column of the time"});
  f.choice("time_unit", c.time_unit,
           {{"s", CsvTimeUnit::kSeconds},
            {"ms", CsvTimeUnit::kMilliseconds},
            {"us", CsvTimeUnit::kMicroseconds},
            {"ns", CsvTimeUnit::kNanoseconds}},
           {.unit = "-", .meaning = "unit of the time"});
  f.texts("gyro", c.gyro, columns_of("the angular velocity x, y, z"));
  f.texts("accelerometer", c.accelerometer, columns_of("the specific force x, y, z"));
  f.choice("gyro_unit", c.gyro_unit,
           {{"rad/s", CsvTurnUnit::kRadians}, {"deg/s", CsvTurnUnit::kDegrees}},
           {.unit = "-", .meaning = "unit of the angular velocity"});
  f.texts("orientation", c.orientation, columns_of("the IMU's quaternion x, y, z, w"));
  f.texts("joint_position", c.joint_position,
          columns_of("the joint angles [rad], per leg (FL, FR, RL, RR) abduction, hip, knee"));
  f.texts("joint_velocity", c.joint_velocity,
          columns_of("the joint rates [rad/s] in the same order"));
  f.texts("foot_force", c.foot_force, columns_of("the loads of the feet FL, FR, RL, RR"));
}

Result<CsvMapping> read_csv_mapping(const std::filesystem::path& file) {
  CsvMapping mapping;
  if (auto ok = load_config(file, mapping); !ok) return tl::unexpected(ok.error());
  const auto lists = std::to_array<ColumnList>({{"gyro", mapping.gyro, 3},
                                                {"accelerometer", mapping.accelerometer, 3},
                                                {"orientation", mapping.orientation, 4},
                                                {"joint_position", mapping.joint_position, 12},
                                                {"joint_velocity", mapping.joint_velocity, 12},
                                                {"foot_force", mapping.foot_force, 4}});
  for (const ColumnList& each : lists) {
    if (each.columns.empty() || each.columns.size() == each.expected) continue;
    return failure(fmt::format("{}: {}: expected {} columns or none, found {}", file.string(),
                               each.key, each.expected, each.columns.size()));
  }
  if (mapping.file.empty()) {
    return failure(fmt::format("{}: file: expected the name of a table (.csv)", file.string()));
  }
  if (mapping.gyro.empty() != mapping.accelerometer.empty()) {
    return failure(fmt::format("{}: expected gyro and accelerometer together", file.string()));
  }
  const bool needs_gyro = !mapping.orientation.empty() && mapping.gyro.empty();
  if (needs_gyro || (!mapping.joint_velocity.empty() && mapping.joint_position.empty())) {
    return failure(fmt::format("{}: {}: has no effect without {}", file.string(),
                               needs_gyro ? "orientation" : "joint_velocity",
                               needs_gyro ? "gyro" : "joint_position"));
  }
  return mapping;
}

}  // namespace aims
