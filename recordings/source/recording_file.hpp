// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include "core/error.hpp"
#include "recordings/bag/bag_writer.hpp"
#include "recordings/bag/chunk_reader.hpp"
#include "recordings/bag/message_sink.hpp"
#include "recordings/bag/message_source.hpp"

namespace aims {

/// The containers of a recording.
enum class RecordingFormat {
  kBag,      ///< ROS 1 bag, format 2.0
  kMcap,     ///< MCAP, with messages of ROS 2 or ROS 1
  kRosbag2,  ///< folder of rosbag2, with SQLite or MCAP files, or one such SQLite file
  kPcap,     ///< capture of the packets of a Velodyne, Hesai or Ouster
  kCsv,      ///< table of comma-separated values: the YAML file that maps its columns
};

/// The format of a file by its first bytes, or of a folder by its metadata.yaml; else nothing.
std::optional<RecordingFormat> format_by_content(const std::filesystem::path& file);

/// The format that a name's extension stands for: ".bag", ".mcap", ".db3", ".pcap" or
/// ".yaml"; else nothing.
std::optional<RecordingFormat> format_by_name(const std::filesystem::path& file);

/// Says how many rows of a table have no time.
std::string untimed_text(const BagSummary& summary);

/// Why such a beginning of a file is that of no recording or trajectory: a page of a download, a
/// pointer of Git LFS, an archive; else empty.
std::string_view foreign_content(std::string_view start);

/// Opens a recording of any format, by its content, merged with the files of `options.with`. A
/// folder without metadata.yaml whose files are not those of one rosbag2 recording is all
/// recordings in it, merged. Error for a file of no format, that its reader refuses, or that is
/// named twice.
Result<std::unique_ptr<MessageSource>> open_recording(const std::filesystem::path& file,
                                                      BagOpenOptions options = {});

/// The same with the clouds and IMU that packets of LiDARs in it become (`decode_packets`).
/// `without_lidar`: packets that cannot be decoded are no error.
Result<std::unique_ptr<MessageSource>> open_sensor_recording(const std::filesystem::path& file,
                                                             BagOpenOptions options = {},
                                                             bool without_lidar = false);

/// A new recording of ROS 1 messages (bag) or ROS 2 messages (the others). Error when the file or
/// folder exists or cannot be written, or when the format does not know the compression.
Result<std::unique_ptr<MessageSink>> create_recording(const std::filesystem::path& file,
                                                      RecordingFormat format,
                                                      BagWriterOptions options = {});

}  // namespace aims
