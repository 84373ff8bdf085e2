// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <fstream>
#include <memory>
#include <span>
#include <string>

#include "core/error.hpp"
#include "core/files/csv.hpp"
#include "core/trajectory.hpp"
#include "estimator/health.hpp"

namespace aims {

/// NAME.tum and NAME.health.csv of a live estimate, as `aims estimate` writes them. Each row is in
/// the file as soon as it is added: a crash or a power failure loses at most the last second.
class LiveLog {
 public:
  /// No folder: nothing is written. Error when it cannot be made or has such files.
  static Result<LiveLog> create(const std::filesystem::path& folder, const std::string& name);

  /// Appends the rows. Error when the disk is full.
  Result<void> add(std::span<const StampedPose> poses, std::span<const HealthRow> health);

 private:
  LiveLog();

  std::filesystem::path folder_;
  std::ofstream poses_;
  std::ofstream health_;
  CsvTable health_table_;
};

}  // namespace aims
