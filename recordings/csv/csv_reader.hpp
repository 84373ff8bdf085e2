// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <memory>

#include "core/error.hpp"
#include "recordings/bag/chunk_reader.hpp"
#include "recordings/bag/kind_source.hpp"

namespace aims {

/// Reads a table of comma-separated values by its mapping (`CsvMapping`) as messages: of each row a
/// sensor_msgs/Imu, an aims_msgs/FootForces and a sensor_msgs/JointState, where all their cells are
/// numbers. A row with empty cells lacks those messages; one without a time is left out and counted.
class CsvReader final : public KindSource {
 public:
  /// `mapping`: a YAML file. Errors name file and row; times must not decrease, and at most a
  /// tenth of the rows may lack one.
  static Result<CsvReader> open(const std::filesystem::path& mapping, BagOpenOptions options = {});
  CsvReader(CsvReader&&) noexcept;
  CsvReader& operator=(CsvReader&&) noexcept;
  ~CsvReader() override;

  std::string name() const override;
  void rewind() override;

 private:
  struct Impl;
  explicit CsvReader(std::unique_ptr<Impl> impl);
  /// The offset is the number of the row, from 1.
  Result<std::optional<Made>> make() override;
  std::unique_ptr<Impl> impl_;
};

}  // namespace aims
