// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <fstream>
#include <map>
#include <span>
#include <string>
#include <vector>

#include "core/error.hpp"
#include "core/files/csv.hpp"
#include "core/trajectory.hpp"
#include "estimator/interface/estimator.hpp"
#include "recordings/stream/recording_reader.hpp"

namespace aims {

/// The folder of a live estimate, as `aims estimate` writes it: NAME.tum, NAME.health.csv,
/// NAME.map.ply and estimate.json. Rows are in their files as soon as they are added, the others
/// now and then: after a crash or a power failure, what is there can be used.
class LiveLog {
 public:
  /// No folder: nothing is written. Error when it cannot be made or has such files
  /// with content: a run without any message leaves empty ones.
  static Result<LiveLog> create(const std::filesystem::path& folder, const std::string& name);

  /// Appends the rows. After an error nothing more is written: a full disk must not end the
  /// estimate.
  void add(std::span<const StampedPose> poses, std::span<const HealthRow> health);

  /// Writes the map, in the odometry frame [m]; nothing without points.
  Result<void> save_map(std::span<const Eigen::Vector3f> points) const;

  /// The first error of `add`: no space left.
  const Result<void>& state() const { return state_; }

  /// Writes estimate.json: what was read so far, counts of the reader and of the estimator, poses.
  /// `complete`: the estimate has ended.
  Result<void> save_summary(const RecordingReader& reader, const EstimatorResult& result,
                            bool complete) const;

  const std::filesystem::path& folder() const { return folder_; }  ///< empty: none

 private:
  std::filesystem::path folder_;
  std::string name_;
  std::ofstream poses_;
  std::ofstream health_;
  CsvTable health_table_{{"stamp_s", "state", "reasons", "position_sigma_m"}};
  std::size_t count_ = 0;  ///< poses
  Result<void> state_;
  double path_m_ = 0.0;
  Eigen::Vector3d first_ = Eigen::Vector3d::Zero();
  Eigen::Vector3d last_ = Eigen::Vector3d::Zero();
};

}  // namespace aims
