// SPDX-License-Identifier: BSD-3-Clause
#include "recordings/messages/number_type.hpp"

#include <algorithm>
#include <array>

#include "core/files/byte_cursor.hpp"

namespace aims {
namespace {

double little_endian_at(const std::byte* bytes, NumberType type) {
  switch (type) {
    case NumberType::kInt8:
      return load_number<std::int8_t>(bytes);
    case NumberType::kUint8:
      return load_number<std::uint8_t>(bytes);
    case NumberType::kInt16:
      return load_number<std::int16_t>(bytes);
    case NumberType::kUint16:
      return load_number<std::uint16_t>(bytes);
    case NumberType::kInt32:
      return load_number<std::int32_t>(bytes);
    case NumberType::kUint32:
      return load_number<std::uint32_t>(bytes);
    case NumberType::kInt64:
      return static_cast<double>(load_number<std::int64_t>(bytes));
    case NumberType::kUint64:
      return static_cast<double>(load_number<std::uint64_t>(bytes));
    case NumberType::kFloat32:
      return load_number<float>(bytes);
    case NumberType::kFloat64:
      return load_number<double>(bytes);
  }
  return 0.0;
}

}  // namespace

std::string_view name_of(NumberType type) {
  static constexpr std::array<std::string_view, 10> kNames = {
      "int8",   "uint8", "int16",  "uint16",  "int32",
      "uint32", "int64", "uint64", "float32", "float64"};
  return kNames[static_cast<std::size_t>(type)];
}

std::size_t size_of(NumberType type) {
  static constexpr std::array<std::size_t, 10> kSizes = {1, 1, 2, 2, 4, 4, 8, 8, 4, 8};
  return kSizes[static_cast<std::size_t>(type)];
}

double number_at(const std::byte* bytes, NumberType type, std::endian order) {
  if (order == std::endian::little) return little_endian_at(bytes, type);
  std::array<std::byte, 8> swapped{};
  std::reverse_copy(bytes, bytes + size_of(type), swapped.begin());
  return little_endian_at(swapped.data(), type);
}

const ColumnLayout* find_column(std::span<const ColumnLayout> columns, std::string_view name) {
  const auto found = std::ranges::find(columns, name, &ColumnLayout::name);
  return found == columns.end() ? nullptr : &*found;
}

}  // namespace aims
