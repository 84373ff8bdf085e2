// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>

#include "core/error.hpp"
#include "core/time.hpp"
#include "recordings/messages/message_type.hpp"

namespace aims {

/// A recording that is being written.
class MessageSink {
 public:
  virtual ~MessageSink() = default;

  /// Of the messages that it takes.
  virtual Serialization serialization() const = 0;

  /// Announces a topic; returns the id to write with. Late subscribers receive the last message of
  /// a latching topic.
  virtual std::uint32_t add_connection(const std::string& topic, const MessageType& type,
                                       bool latching) = 0;

  /// Appends a message. Error when the disk is full.
  virtual Result<void> write(std::uint32_t connection, Time record_time,
                             std::span<const std::byte> data) = 0;

  /// Writes what is left and closes the file. Nothing may be written afterwards.
  virtual Result<void> close() = 0;

 protected:
  MessageSink() = default;
  MessageSink(MessageSink&&) = default;
  MessageSink& operator=(MessageSink&&) = default;
};

}  // namespace aims
