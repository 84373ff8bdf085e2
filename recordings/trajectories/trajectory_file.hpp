// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "core/error.hpp"
#include "core/files/tum.hpp"
#include "core/trajectory.hpp"

namespace aims {

/// Stamps that poses without any (KITTI) may take, and what to call them.
struct StampList {
  std::string name;  ///< e.g. "times.txt", "the truth"
  std::vector<Time> stamps;
};

/// How a trajectory of whatever kind is read.
struct TrajectoryFileOptions {
  PoseRules rules = PoseRules::kStrict;
  /// Of a bag with several topics that hold poses, when the source names none; may be empty.
  std::string preferred_topic = {};
  /// For poses without stamps: the first list with as many entries as there are poses.
  std::vector<StampList> stamps = {};
};

/// A trajectory, and what its file says of it.
struct TrajectoryFile {
  Trajectory trajectory;  ///< stamps increase and poses are valid only under strict rules
  std::string kind;       ///< "TUM", "KITTI poses", "nav_msgs/Odometry on /odom"
  std::filesystem::path file;
  std::string topic;               ///< of a bag
  std::string body_frame;          ///< whose poses they are, where a bag says; e.g. "lidar"
  std::vector<std::string> notes;  ///< what was assumed or left out, a sentence each
};

/// Reads `source`: a text file of TUM lines or KITTI poses, told by its columns, or a ROS 1 bag,
/// told by its first bytes, with the topic behind a colon ("run.bag:/odom"). Errors are one line
/// with the file, its line or offset, and what was expected; for a topic, those that exist.
Result<TrajectoryFile> read_trajectory(const std::string& source,
                                       const TrajectoryFileOptions& options);

/// Whether the file begins as a ROS 1 bag does.
bool is_bag(const std::filesystem::path& file);

}  // namespace aims
