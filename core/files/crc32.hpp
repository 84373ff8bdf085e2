// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

namespace aims {

/// CRC-32 as in zlib and PNG (ISO 3309) of bytes that may come in pieces.
class Crc32 {
 public:
  void add(std::span<const std::byte> bytes);
  std::uint32_t value() const { return value_; }

 private:
  std::uint32_t value_ = 0;
};

std::uint32_t crc32_of(std::span<const std::byte> bytes);

}  // namespace aims
