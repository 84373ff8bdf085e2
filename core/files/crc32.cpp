// SPDX-License-Identifier: BSD-3-Clause
#include "core/files/crc32.hpp"

#define ZLIB_CONST  // as in inflate.cpp, which may be compiled with it
#include <zlib.h>

namespace aims {

void Crc32::add(std::span<const std::byte> bytes) {
  // zlib takes no bytes, at no address, for the question of the first value.
  if (bytes.empty()) return;
  value_ = static_cast<std::uint32_t>(
      crc32_z(value_, reinterpret_cast<const Bytef*>(bytes.data()), bytes.size()));
}

std::uint32_t crc32_of(std::span<const std::byte> bytes) {
  Crc32 crc;
  crc.add(bytes);
  return crc.value();
}

}  // namespace aims
