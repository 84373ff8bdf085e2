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

/// One field in the order of the bytes; the fields of a nested message take its place. A segment
/// ends with a slot of variable size: within it all offsets are known without the data.
struct FieldSlot {
  std::string path;
  FieldKind kind = FieldKind::kNumber;
  NumberType number = NumberType::kUint8;
  bool is_bool = false;
  bool is_signed = false;        ///< a duration
  bool counted = false;          ///< an array of variable length: its count comes first
  std::uint32_t count = 1;       ///< entries otherwise
  std::uint32_t element = 0;     ///< layout of the messages in an array
  std::uint32_t entry_size = 0;  ///< bytes of one entry; 0: variable
  std::uint32_t segment = 0;
  std::uint32_t offset = 0;  ///< within the segment [bytes]

  bool is_variable() const { return counted || entry_size == 0; }
  bool is_array() const { return kind >= FieldKind::kNumbers; }
};

/// Where the fields of one message type lie in its bytes.
struct MessageLayout {
  std::string type;
  std::vector<FieldSlot> slots;
  std::unordered_map<std::string_view, std::uint32_t> by_path;  ///< slot of each path
  std::vector<std::uint32_t> variable_slots;         ///< the last of each segment but the final one
  std::vector<std::uint32_t> segment_sizes;          ///< known bytes of each segment
  std::optional<std::vector<ColumnLayout>> columns;  ///< if it can be the row of a table
  int depth = 1;

  bool is_fixed() const { return variable_slots.empty(); }
  std::uint32_t fixed_size() const { return segment_sizes.front(); }
};

/// The layouts of a type and of all types that it holds in arrays; the last is the type's own.
Result<std::vector<MessageLayout>> message_layouts(std::string_view type,
                                                   std::string_view definition);

}  // namespace aims
