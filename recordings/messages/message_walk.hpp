// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "recordings/messages/message_plan.hpp"

namespace aims {

/// Where a message's bytes are not as its definition says.
struct WalkError {
  std::string field;         ///< path within the message that was walked
  std::size_t offset = 0;    ///< in the bytes
  std::uint64_t wanted = 0;  ///< bytes that the field needs there
};

/// Walks over serialized messages, each length held against the bytes that are there.
class MessageWalk {
 public:
  MessageWalk(const std::vector<MessagePlan>& plans, std::span<const std::byte> bytes)
      : plans_(plans), bytes_(bytes) {}

  /// Where the message at `start` ends, or nothing, and `error()` says why. `segments`, if given,
  /// takes the starts of its segments.
  std::optional<std::size_t> end_of(const MessagePlan& plan, std::size_t start,
                                    std::uint32_t* segments = nullptr);
  /// Where the slot of open size at `start` ends.
  std::optional<std::size_t> end_of(const MessageSlot& slot, std::size_t start);
  /// Start of a slot of the message at `start`, which has been walked over before.
  std::size_t start_of(const MessagePlan& plan, const MessageSlot& slot, std::size_t start);
  /// Entries of the array at `start`, and where its first entry lies.
  std::optional<std::uint32_t> count_of(const MessageSlot& slot, std::size_t& start);

  const WalkError& error() const { return error_; }

 private:
  std::nullopt_t fail(const std::string& field, std::size_t offset, std::uint64_t wanted);
  bool has(std::size_t start, std::uint64_t size) const {
    return start <= bytes_.size() && size <= bytes_.size() - start;
  }

  const std::vector<MessagePlan>& plans_;
  std::span<const std::byte> bytes_;
  WalkError error_;
};

}  // namespace aims
