// SPDX-License-Identifier: BSD-3-Clause
#include "recordings/mcap/crc32.hpp"

#include <array>

#include "core/files/byte_cursor.hpp"

namespace aims {
namespace {

/// Row k: the remainder of each byte followed by k zero bytes.
using Tables = std::array<std::array<std::uint32_t, 256>, 8>;

constexpr Tables make_tables() {
  constexpr std::uint32_t kPolynomial = 0xedb88320;  // bits reversed
  Tables tables{};
  for (std::uint32_t byte = 0; byte < 256; ++byte) {
    std::uint32_t rest = byte;
    for (int bit = 0; bit < 8; ++bit) rest = (rest >> 1) ^ ((rest & 1) != 0 ? kPolynomial : 0);
    tables[0][byte] = rest;
  }
  for (std::size_t k = 1; k < tables.size(); ++k) {
    for (std::size_t byte = 0; byte < 256; ++byte) {
      const std::uint32_t before = tables[k - 1][byte];
      tables[k][byte] = (before >> 8) ^ tables[0][before & 0xff];
    }
  }
  return tables;
}

constexpr Tables kTables = make_tables();

}  // namespace

void Crc32::add(std::span<const std::byte> bytes) {
  // Eight bytes at a time.
  while (bytes.size() >= 8) {
    const std::uint32_t low = load_number<std::uint32_t>(bytes.data()) ^ state_;
    const auto high = load_number<std::uint32_t>(bytes.data() + 4);
    state_ = kTables[7][low & 0xff] ^ kTables[6][(low >> 8) & 0xff] ^
             kTables[5][(low >> 16) & 0xff] ^ kTables[4][low >> 24] ^ kTables[3][high & 0xff] ^
             kTables[2][(high >> 8) & 0xff] ^ kTables[1][(high >> 16) & 0xff] ^
             kTables[0][high >> 24];
    bytes = bytes.subspan(8);
  }
  for (const std::byte byte : bytes) {
    const std::uint32_t place = (state_ ^ std::to_integer<std::uint32_t>(byte)) & 0xff;
    state_ = (state_ >> 8) ^ kTables[0][place];
  }
}

std::uint32_t crc32_of(std::span<const std::byte> bytes) {
  Crc32 crc;
  crc.add(bytes);
  return crc.value();
}

}  // namespace aims
