// SPDX-License-Identifier: BSD-3-Clause
#include "recordings/mcap/mcap_record_builder.hpp"

#include <cstring>

namespace aims {

McapRecordBuilder::McapRecordBuilder(std::vector<std::byte>& out, McapOp op) : out_(out) {
  number(static_cast<std::uint8_t>(op));
  number(std::uint64_t{0});
  start_ = out_.size();
}

McapRecordBuilder& McapRecordBuilder::bytes(std::span<const std::byte> value) {
  append(out_, value);
  return *this;
}

void McapRecordBuilder::finish() {
  const std::uint64_t size = out_.size() - start_;
  std::memcpy(out_.data() + start_ - sizeof(size), &size, sizeof(size));
}

}  // namespace aims
