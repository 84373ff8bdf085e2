// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "core/config.hpp"
#include "core/error.hpp"

namespace aims {

enum class CsvTimeUnit { kSeconds, kMilliseconds, kMicroseconds, kNanoseconds };
enum class CsvTurnUnit { kRadians, kDegrees };

/// Which columns of a table of comma-separated values hold what. Empty lists: not in the table.
struct CsvMapping {
  std::string file;  ///< the table, beside the mapping
  std::string time = "time";
  CsvTimeUnit time_unit = CsvTimeUnit::kSeconds;
  std::vector<std::string> gyro;           ///< x, y, z
  std::vector<std::string> accelerometer;  ///< x, y, z: specific force [m/s^2] or [g]
  CsvTurnUnit gyro_unit = CsvTurnUnit::kRadians;
  std::vector<std::string> orientation;     ///< x, y, z, w of a quaternion
  std::vector<std::string> joint_position;  ///< FL, FR, RL, RR: abduction, hip, knee [rad]
  std::vector<std::string> joint_velocity;  ///< the same [rad/s]; none: from the angles
  std::vector<std::string> foot_force;      ///< FL, FR, RL, RR, in any unit
};

void describe(Fields& fields, CsvMapping& mapping);

/// Reads a mapping. Errors name file, line and key; the lists have 3, 3, 4, 12, 12 and 4 columns or
/// none, and gyro and accelerometer come together.
Result<CsvMapping> read_csv_mapping(const std::filesystem::path& file);

}  // namespace aims
