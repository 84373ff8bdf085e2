// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

#include "core/files/byte_cursor.hpp"
#include "recordings/mcap/mcap_records.hpp"

namespace aims {

/// Appends one MCAP record: fields in the order added.
class McapRecordBuilder {
 public:
  McapRecordBuilder(std::vector<std::byte>& out, McapOp op);

  template <class T>
  McapRecordBuilder& number(T value) {
    return bytes({reinterpret_cast<const std::byte*>(&value), sizeof(value)});
  }
  McapRecordBuilder& text(std::string_view value) { return entries(bytes_of(value)); }
  McapRecordBuilder& bytes(std::span<const std::byte> value);
  /// An array or a map: the length of its entries, then the entries.
  McapRecordBuilder& entries(std::span<const std::byte> value) {
    return number(static_cast<std::uint32_t>(value.size())).bytes(value);
  }
  /// Writes the length of the record.
  void finish();

 private:
  std::vector<std::byte>& out_;
  std::size_t start_ = 0;
};

}  // namespace aims
