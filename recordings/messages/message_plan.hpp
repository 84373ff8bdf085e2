// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

#include "core/error.hpp"
#include "recordings/messages/message_decoder.hpp"

namespace aims {

/// One field in the flat order of the bytes; those of nested messages stand in its place. Bytes up
/// to a slot of open size, and that slot, are a segment: within it all places are known beforehand.
struct MessageSlot {
  std::string path;
  FieldKind kind = FieldKind::kNumber;
  NumberType number = NumberType::kUint8;
  bool is_bool = false;
  bool is_signed = false;        ///< a duration
  bool counted = false;          ///< an array of open length: its count comes first
  std::uint32_t count = 1;       ///< entries otherwise
  std::uint32_t element = 0;     ///< plan of the messages in an array
  std::uint32_t entry_size = 0;  ///< bytes of one entry; 0: open
  std::uint32_t segment = 0;
  std::uint32_t offset = 0;  ///< within the segment [bytes]

  bool is_open() const { return counted || entry_size == 0; }
  bool is_array() const { return kind >= FieldKind::kNumbers; }
};

/// How the bytes of one message type lie.
struct MessagePlan {
  std::string type;
  std::vector<MessageSlot> slots;
  std::unordered_map<std::string_view, std::uint32_t> by_path;  ///< slot of each path
  std::vector<std::uint32_t> open_slots;             ///< the last of each segment but the final one
  std::vector<std::uint32_t> segment_sizes;          ///< known bytes of each segment
  std::optional<std::vector<ColumnLayout>> columns;  ///< where it can be the row of a table
  int depth = 1;

  bool is_fixed() const { return open_slots.empty(); }
  std::uint32_t fixed_size() const { return segment_sizes.front(); }
};

/// The plans of a type and of all types that it holds in arrays; the last is the type's own.
Result<std::vector<MessagePlan>> plan_message(std::string_view type, std::string_view definition);

}  // namespace aims
