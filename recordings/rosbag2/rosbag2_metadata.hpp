// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "core/error.hpp"
#include "core/time.hpp"
#include "recordings/bag/message_source.hpp"

namespace aims {

/// The file of a rosbag2 folder that describes it.
inline constexpr const char* kRosbag2Metadata = "metadata.yaml";

/// What reading needs of it.
struct Rosbag2Metadata {
  std::vector<std::filesystem::path> files;  ///< in order of time
  bool compressed = false;                   ///< by zstd, its files or its messages
};

/// Reads the metadata of a folder; its files exist. Error, naming file and key, for what
/// contradicts rosbag2 and for a compression other than zstd.
Result<Rosbag2Metadata> read_rosbag2_metadata(const std::filesystem::path& folder);

/// The recorded files of a folder without metadata, in order of their numbers: NAME_0.db3,
/// NAME_1.db3. None for those of several recordings.
std::vector<std::filesystem::path> rosbag2_files(const std::filesystem::path& folder);

/// The metadata, in version 5 (ROS 2 Humble), of a folder with one SQLite file. `topics` and their
/// message counts, `start` and `end` of the recording.
std::string rosbag2_metadata_text(const std::string& file, std::span<const BagConnection> topics,
                                  Time start, Time end);

}  // namespace aims
