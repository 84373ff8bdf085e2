// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>
#include <string>

#include "core/error.hpp"
#include "core/time.hpp"
#include "recordings/bag/compression.hpp"
#include "recordings/bag/message_sink.hpp"
#include "recordings/messages/message_type.hpp"

namespace aims {

class BagOutput;

struct BagWriterOptions {
  BagCompression compression = BagCompression::kNone;
  std::size_t chunk_size = std::size_t{4} << 20;  ///< a chunk is closed when it has this many bytes
};

/// Writes a ROS 1 bag (format 2.0). After each closed chunk the file on disk is a valid bag with an
/// index of all closed chunks: a process killed at any moment leaves a readable bag.
class BagWriter final : public MessageSink {
 public:
  /// Error when the file exists or cannot be written.
  static Result<BagWriter> create(const std::filesystem::path& file, BagWriterOptions options = {});
  /// Writes to an output that begins with an empty bag; errors call it `name`.
  static Result<BagWriter> create(std::unique_ptr<BagOutput> output, const std::string& name,
                                  BagWriterOptions options = {});
  BagWriter(BagWriter&&) noexcept;
  BagWriter& operator=(BagWriter&&) noexcept;
  ~BagWriter() override;  ///< closes and ignores errors: call `close` to see them

  Serialization serialization() const override { return Serialization::kRos1; }

  std::uint32_t add_connection(const std::string& topic, const MessageType& type,
                               bool latching = false) override;

  /// Appends a message as serialized by ROS 1. Error when the disk is full; the bag then remains
  /// readable up to the last closed chunk. `record_time` > 0: rosbag's own reader skips messages at
  /// 0.
  Result<void> write(std::uint32_t connection, Time record_time,
                     std::span<const std::byte> data) override;

  /// Closes the last chunk and the file. Nothing may be written afterwards.
  Result<void> close() override;

 private:
  struct Impl;
  explicit BagWriter(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

}  // namespace aims
