// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>
#include <string>

#include "core/error.hpp"
#include "recordings/bag/bag_writer.hpp"
#include "recordings/bag/message_sink.hpp"

namespace aims {

/// Writes an MCAP file of ROS 2 messages (profile ros2), with indexes and checksums; chunks
/// uncompressed, lz4 or zstd. Of a process killed at any moment, `--recover` reads the closed
/// chunks.
class McapWriter final : public MessageSink {
 public:
  /// Error when the file exists or cannot be written.
  static Result<McapWriter> create(const std::filesystem::path& file,
                                   BagWriterOptions options = {});
  McapWriter(McapWriter&&) noexcept;
  McapWriter& operator=(McapWriter&&) noexcept;
  ~McapWriter() override;  ///< closes and ignores errors: call `close` to see them

  Serialization serialization() const override { return Serialization::kCdr; }
  /// Late subscribers of ROS 2 receive the last message of a latching topic (transient local).
  std::uint32_t add_connection(const std::string& topic, const MessageType& type,
                               bool latching) override;
  /// Record times, >= 0, become log and publish times.
  Result<void> write(std::uint32_t connection, Time record_time,
                     std::span<const std::byte> data) override;
  Result<void> close() override;

 private:
  struct Impl;
  explicit McapWriter(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

}  // namespace aims
