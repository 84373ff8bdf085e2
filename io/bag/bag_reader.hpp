// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/error.hpp"
#include "core/time.hpp"

namespace aims {

/// One topic as one publisher recorded it.
struct BagConnection {
  std::uint32_t id = 0;
  std::string topic;
  std::string type;        ///< e.g. "sensor_msgs/PointCloud2"
  std::string md5;         ///< of the definition
  std::string definition;  ///< the message type in words, with all types that it uses
  bool latching = false;
  std::uint64_t messages = 0;  ///< in the bag, by its index
};

/// One recorded message; valid until the reader moves on.
struct BagMessage {
  const BagConnection* connection = nullptr;
  Time record_time = 0;             ///< since the epoch
  std::span<const std::byte> data;  ///< as serialized by ROS 1, little endian
  std::uint64_t offset = 0;         ///< of the chunk that holds it, in the file [bytes]
};

/// What the index of a bag says.
struct BagSummary {
  std::uint64_t file_size = 0;  ///< [bytes]
  std::uint64_t chunks = 0;
  std::uint64_t messages = 0;
  std::uint64_t lost_bytes = 0;  ///< in chunks that are not whole, and behind; when recovered
  Time start = 0;                ///< earliest record time, since the epoch
  Time end = 0;                  ///< latest record time
  std::string compression;       ///< "none", "lz4", "bz2", or several: "lz4, none"
  bool indexed = true;           ///< false: never closed, read by scanning
};

struct BagOpenOptions {
  /// Read what is whole in a bag that was never closed or was cut short, instead of an error.
  bool recover = false;
  /// Chunks in memory at a time; a bag that needs more is an error [bytes].
  std::size_t memory_limit = std::size_t{1} << 30;
};

/// Reads a ROS 1 bag (format 2.0) message by message in order of record time, then of place in the
/// file. Memory is bounded by the chunks that overlap in time, never by what the file claims: each
/// length is checked before it is believed. Errors name the file, the offset and what was expected.
class BagReader {
 public:
  static Result<BagReader> open(const std::filesystem::path& file, BagOpenOptions options = {});
  BagReader(BagReader&&) noexcept;
  BagReader& operator=(BagReader&&) noexcept;
  ~BagReader();

  const std::filesystem::path& file() const;
  /// In order of their ids.
  const std::vector<BagConnection>& connections() const;
  const BagSummary& summary() const;

  /// From here on only messages of these topics are given; chunks without them are not read.
  /// Topics that the bag does not have are no error.
  void select(std::span<const std::string> topics);

  /// The next message, or nothing at the end.
  Result<std::optional<BagMessage>> next();

  /// Starts again at the first message.
  void rewind();

 private:
  struct Impl;
  explicit BagReader(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

}  // namespace aims
