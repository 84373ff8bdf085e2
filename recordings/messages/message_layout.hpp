// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

#include "core/error.hpp"
#include "recordings/messages/message_decoder.hpp"
#include "recordings/messages/message_type.hpp"

namespace aims {

/// A number of bytes for each place, modulo 8, at which a segment may start: CDR aligns numbers to
/// their size, counted from the start of the message. Without alignment all eight are equal.
using BytesByPhase = std::array<std::uint32_t, 8>;

/// The next place at or behind `place` that is a multiple of `alignment`, a power of two.
constexpr std::size_t aligned(std::size_t place, std::uint32_t alignment) {
  return (place + alignment - 1) & ~std::size_t{alignment - 1};
}

/// One field in the order of the bytes; the fields of a nested message take its place. A segment
/// ends with a slot of variable size: within it all offsets are known without the data.
struct FieldSlot {
  std::string path;
  FieldKind kind = FieldKind::kNumber;
  NumberType number = NumberType::kUint8;
  bool is_bool = false;
  NumberType fraction = NumberType::kUint32;  ///< of a time, whose seconds are `number`
  bool counted = false;          ///< an array of variable length: its count comes first
  std::uint32_t count = 1;       ///< entries otherwise
  std::uint32_t element = 0;     ///< layout of the messages in an array
  std::uint32_t entry_size = 0;  ///< from one entry to the next [bytes]; 0: variable
  std::uint32_t last_size = 0;   ///< of the last entry, which nothing pads
  std::uint32_t alignment = 1;   ///< of entries [bytes]
  std::uint32_t segment = 0;
  BytesByPhase offset{};            ///< within the segment
  bool is_sequence_number = false;  ///< of a std_msgs/Header, which ROS 1 alone has
  bool is_placeholder = false;      ///< of a type without fields, which takes a byte in CDR; has no
                                    ///< path

  bool is_variable() const { return counted || entry_size == 0; }
  bool is_array() const { return kind >= FieldKind::kNumbers; }
  /// Bytes of `entries` entries.
  std::uint64_t size_of_entries(std::uint64_t entries) const {
    return entries == 0 ? 0 : (entries - 1) * entry_size + last_size;
  }
};

/// Where the fields of one message type lie in its bytes.
struct MessageLayout {
  std::string type;
  Serialization serialization = Serialization::kRos1;
  std::vector<FieldSlot> slots;
  std::unordered_map<std::string_view, std::uint32_t> by_path;  ///< slot of each path
  std::vector<std::uint32_t> variable_slots;         ///< the last of each segment but the final one
  std::vector<BytesByPhase> segment_sizes;           ///< known bytes of each segment
  std::optional<std::vector<ColumnLayout>> columns;  ///< if it can be the row of a table
  std::uint32_t alignment = 1;                       ///< largest of its fields
  int depth = 1;

  bool is_fixed() const { return variable_slots.empty(); }
  /// Whether the layout is the same wherever a multiple of its alignment begins, and nowhere else:
  /// messages of it in a row then lie at a constant distance.
  bool is_regular() const {
    return is_fixed() && (alignment == 1 || slots.front().alignment == alignment);
  }
  /// Bytes of a regular one.
  std::uint32_t fixed_size() const { return segment_sizes.front().front(); }
};

/// The layouts of a type and of all types that it holds in arrays; the last is the type's own.
Result<std::vector<MessageLayout>> message_layouts(std::string_view type,
                                                   std::string_view definition,
                                                   MessageFormat format = kRos1Format);

}  // namespace aims
