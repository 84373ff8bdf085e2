// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/error.hpp"
#include "core/files/tum.hpp"
#include "core/trajectory.hpp"

namespace aims {

/// Stamps for poses without stamps (KITTI), and their name in messages.
struct StampList {
  std::string name;  ///< e.g. "times.txt", "the truth"
  std::vector<Time> stamps;
};

/// How a trajectory file is read.
struct TrajectoryFileOptions {
  PoseRules rules = PoseRules::kStrict;
  /// Topic of a bag with several pose topics, if the source names none; may be empty.
  std::string preferred_topic = {};
  /// For poses without stamps: the first list of the same length is used.
  std::vector<StampList> stamps = {};
  /// By how many decimals the unit of stamps in text files lies below seconds: 9 of nanoseconds.
  int stamp_decimals = 0;
};

inline constexpr std::string_view kKittiPoses = "KITTI poses";

/// A trajectory and its origin.
struct TrajectoryFile {
  Trajectory trajectory;  ///< stamps increase and poses are valid only under strict rules
  std::string kind;       ///< "TUM", "KITTI poses", "nav_msgs/Odometry on /odom"
  std::filesystem::path file;
  bool has_attitude = true;        ///< false: positions alone; the rotations are identities
  std::string topic;               ///< of a bag
  std::string body_frame;          ///< child frame of a bag's poses, e.g. "lidar"; may be empty
  std::vector<std::string> notes;  ///< assumptions and dropped poses, one sentence each
  std::string dropped;             ///< of the notes: "2 of 5 poses dropped: ..."
};

/// Reads `source`: a text file of TUM lines, KITTI poses or positions (stamp x y z), distinguished
/// by the number of columns, or a recording, recognized by its first bytes or its name, with the
/// topic after a colon ("run.bag:/odom"), of tf also with two frames ("run.bag:/tf:map,base").
/// Errors name the file, its line or offset, and what was expected; for a topic, the existing ones.
Result<TrajectoryFile> read_trajectory(const std::string& source,
                                       const TrajectoryFileOptions& options);

}  // namespace aims
