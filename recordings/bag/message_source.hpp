// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/error.hpp"
#include "core/time.hpp"
#include "recordings/messages/message_type.hpp"

namespace aims {

/// One topic as one publisher recorded it.
struct BagConnection {
  std::uint32_t id = 0;
  std::string topic;
  std::string type;        ///< e.g. "sensor_msgs/PointCloud2", in ROS 2 too
  std::string md5;         ///< of the definition; ROS 1 alone
  std::string definition;  ///< text of the message type and of all types that it uses
  bool latching = false;
  std::uint64_t messages = 0;  ///< number in the recording, by its index
  MessageFormat format = {};
  bool is_part = false;  ///< its messages are joined with others to those of another topic
  double batch = 0.0;    ///< samples of a batch, where they say when they were taken; 0: none
  std::string joined_from = {};  ///< the topics of which it is made, in words; empty: none
};

/// One recorded message; valid until the next call of the reader.
struct BagMessage {
  const BagConnection* connection = nullptr;
  Time record_time = 0;             ///< since the epoch
  std::span<const std::byte> data;  ///< in the format of the connection
  std::uint64_t offset = 0;         ///< of the chunk that holds it, in the file [bytes]
  /// When the sample was taken, where it has no stamp and its record time is that of a batch.
  std::optional<Time> sampled = std::nullopt;

  /// What serves in place of a stamp.
  Time taken() const { return sampled.value_or(record_time); }
};

/// Totals of a recording, from its index.
struct BagSummary {
  std::uint64_t file_size = 0;  ///< [bytes]
  std::uint64_t chunks = 0;
  std::uint64_t messages = 0;
  std::uint64_t lost_bytes = 0;         ///< in and behind damaged chunks, when recovered
  Time start = 0;                       ///< earliest record time, since the epoch
  Time end = 0;                         ///< latest record time
  std::string compression;              ///< "none", "lz4", "bz2", or several: "lz4, none"
  bool indexed = true;                  ///< false: without index, read by scanning
  bool closed = true;                   ///< false: its writer never completed it
  std::uint64_t lost_messages = 0;      ///< with impossible times, when recovered
  std::uint64_t repeated_messages = 0;  ///< that several files hold, of those read so far
  std::uint64_t untimed_rows = 0;       ///< of a table, left out
  double lost_packets = 0.0;            ///< of a LiDAR's in a capture, as a fraction [0 to 1]
  Duration clock_shift = 0;             ///< largest, of files of recorders whose clocks differ
  bool recorded_at_stamps = false;      ///< record times were all the same: stamps took their place
};

/// Lost packets that are named: a fraction.
inline constexpr double kFewLostPackets = 0.005;

/// Messages in order of record time: a bag, or the topics of a running robot.
class MessageSource {
 public:
  virtual ~MessageSource() = default;

  /// Its name in errors: the bag's path.
  virtual std::string name() const = 0;

  /// In order of their ids; complete from the start.
  virtual const std::vector<BagConnection>& connections() const = 0;

  /// Totals; of a running robot those of the start alone.
  virtual const BagSummary& summary() const = 0;

  /// Restricts `next` to these topics. Absent topics are ignored.
  virtual void select(std::span<const std::string> topics) = 0;

  /// The next message, or nothing at the end.
  virtual Result<std::optional<BagMessage>> next() = 0;

  /// Starts again at the first message. Of a running robot only the messages gathered before the
  /// source was created can be read twice; `next` ends there until the source goes live.
  virtual void rewind() = 0;

 protected:
  MessageSource() = default;
  MessageSource(MessageSource&&) = default;
  MessageSource& operator=(MessageSource&&) = default;
};

/// Selects all topics and rewinds: as when it was opened.
inline void start_anew(MessageSource& source) {
  std::vector<std::string> all;
  for (const BagConnection& each : source.connections()) all.push_back(each.topic);
  source.select(all);
  source.rewind();
}

}  // namespace aims
