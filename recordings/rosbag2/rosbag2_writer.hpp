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

/// Writes a folder NAME, or NAME.partial, as `ros2 bag record` does: NAME_0.db3, in version 4 of
/// rosbag2's schema with the definitions of all types, and metadata.yaml. Of a process killed at
/// any moment, `--recover` reads what was complete.
class Rosbag2Writer final : public MessageSink {
 public:
  /// Error when the folder exists or cannot be written, and for any compression.
  static Result<Rosbag2Writer> create(const std::filesystem::path& folder,
                                      BagWriterOptions options = {});
  Rosbag2Writer(Rosbag2Writer&&) noexcept;
  Rosbag2Writer& operator=(Rosbag2Writer&&) noexcept;
  ~Rosbag2Writer() override;  ///< closes and ignores errors: call `close` to see them

  Serialization serialization() const override { return Serialization::kCdr; }
  /// Late subscribers of ROS 2 receive the last message of a latching topic (transient local).
  std::uint32_t add_connection(const std::string& topic, const MessageType& type,
                               bool latching) override;
  Result<void> write(std::uint32_t connection, Time record_time,
                     std::span<const std::byte> data) override;
  Result<void> close() override;

 private:
  struct Impl;
  explicit Rosbag2Writer(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

}  // namespace aims
