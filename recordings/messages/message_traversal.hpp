// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "recordings/messages/message_layout.hpp"

namespace aims {

/// Where the bytes contradict the definition.
struct TraversalError {
  std::string field;         ///< path within the traversed message
  std::size_t offset = 0;    ///< in the bytes
  std::uint64_t needed = 0;  ///< bytes that the field needs there
};

/// Where the characters of a text lie, and where what follows it may begin.
struct TextPlace {
  std::size_t start = 0;
  std::size_t size = 0;
  std::size_t end = 0;
};

/// Finds where the parts of serialized messages begin and end. Every length is checked against the
/// bytes that are there. Places count from the first byte, to which CDR aligns.
class MessageTraversal {
 public:
  MessageTraversal(const std::vector<MessageLayout>& layouts, std::span<const std::byte> bytes,
                   std::endian order)
      : layouts_(layouts),
        bytes_(bytes),
        order_(order),
        cdr_(layouts.back().serialization == Serialization::kCdr) {}

  /// Where the message at `start` ends, or nothing, with the reason in `error()`. `segments`, if
  /// given, receives the starts of its segments.
  std::optional<std::size_t> end_of(const MessageLayout& layout, std::size_t start,
                                    std::uint32_t* segments = nullptr);
  /// Where the slot of variable size at `start` ends.
  std::optional<std::size_t> end_of(const FieldSlot& slot, std::size_t start);
  /// Start of a slot of the message at `start`, whose end was found before.
  std::size_t start_of(const MessageLayout& layout, const FieldSlot& slot, std::size_t start);
  /// Entries of the array at `start`, and where its first entry lies.
  std::optional<std::uint32_t> count_of(const FieldSlot& slot, std::size_t& start);
  /// Where an entry of an array lies whose first is at `start` and whose end was found before.
  std::size_t start_of_entry(const FieldSlot& slot, std::size_t start, std::uint32_t entry);
  /// The text at `start`.
  std::optional<TextPlace> text_at(const FieldSlot& slot, std::size_t start);

  const TraversalError& error() const { return error_; }

 private:
  std::nullopt_t fail(const std::string& field, std::size_t offset, std::uint64_t needed);
  bool has(std::size_t start, std::uint64_t size) const {
    return start <= bytes_.size() && size <= bytes_.size() - start;
  }
  std::optional<std::uint32_t> length_at(const FieldSlot& slot, std::size_t& start);

  const std::vector<MessageLayout>& layouts_;
  std::span<const std::byte> bytes_;
  std::endian order_;
  bool cdr_;
  TraversalError error_;
};

}  // namespace aims
