// SPDX-License-Identifier: BSD-3-Clause
#include "recordings/messages/number_type.hpp"

#include <algorithm>
#include <array>

#include "core/files/byte_cursor.hpp"

namespace aims {
namespace {

/// Calls `visit` with a number of the C++ type that `type` names.
template <class Visit>
auto with_type(NumberType type, const Visit& visit) {
  switch (type) {
    case NumberType::kInt8:
      return visit(std::int8_t{});
    case NumberType::kUint8:
      return visit(std::uint8_t{});
    case NumberType::kInt16:
      return visit(std::int16_t{});
    case NumberType::kUint16:
      return visit(std::uint16_t{});
    case NumberType::kInt32:
      return visit(std::int32_t{});
    case NumberType::kUint32:
      return visit(std::uint32_t{});
    case NumberType::kInt64:
      return visit(std::int64_t{});
    case NumberType::kUint64:
      return visit(std::uint64_t{});
    case NumberType::kFloat32:
      return visit(float{});
    case NumberType::kFloat64:
      break;
  }
  return visit(double{});
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
  return with_type(
      type, [&]<class T>(T /*type*/) { return static_cast<double>(load_number<T>(bytes, order)); });
}

void numbers_at(const std::byte* bytes, std::size_t stride, NumberType type, std::endian order,
                std::span<double> numbers) {
  with_type(type, [&]<class T>(T /*type*/) {
    if (order == std::endian::little) {
      for (std::size_t i = 0; i < numbers.size(); ++i) {
        numbers[i] = static_cast<double>(load_number<T>(bytes + i * stride));
      }
      return;
    }
    for (std::size_t i = 0; i < numbers.size(); ++i) {
      numbers[i] = static_cast<double>(load_number<T>(bytes + i * stride, order));
    }
  });
}

const ColumnLayout* find_column(std::span<const ColumnLayout> columns, std::string_view name) {
  const auto found = std::ranges::find(columns, name, &ColumnLayout::name);
  return found == columns.end() ? nullptr : &*found;
}

}  // namespace aims
