// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <memory>
#include <span>
#include <vector>

#include "core/error.hpp"
#include "recordings/messages/message_bytes.hpp"
#include "recordings/messages/message_layout.hpp"
#include "recordings/messages/message_type.hpp"

namespace aims {

/// Turns the messages of one ROS 1 type into those of ROS 2: CDR, headers without sequence number.
/// Every value is kept bit by bit.
class CdrTranscoder {
 public:
  /// Error for a definition that cannot be read, or that ROS 2 cannot hold.
  static Result<CdrTranscoder> create(const MessageType& ros1);

  /// The type of the messages that are made.
  const MessageType& type() const { return type_; }

  /// Error for bytes that contradict the definition, and for a time that ROS 2 cannot hold.
  Result<MessageBytes> transcode(std::span<const std::byte> data) const;

 private:
  CdrTranscoder(MessageType type, std::vector<MessageLayout> layouts)
      : type_(std::move(type)), layouts_(std::move(layouts)) {}

  MessageType type_;
  std::vector<MessageLayout> layouts_;
};

}  // namespace aims
