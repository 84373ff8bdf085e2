// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace aims {

/// The types of a number inside a message or a point.
enum class NumberType {
  kInt8,
  kUint8,
  kInt16,
  kUint16,
  kInt32,
  kUint32,
  kInt64,
  kUint64,
  kFloat32,
  kFloat64,
};

/// E.g. "float32".
std::string_view name_of(NumberType type);

/// Bytes of one number.
std::size_t size_of(NumberType type);

/// The number at `bytes`, which holds at least `size_of(type)`.
double number_at(const std::byte* bytes, NumberType type, std::endian order = std::endian::little);

/// Replaces `numbers` by those at `bytes` and every `stride` bytes after it.
void numbers_at(const std::byte* bytes, std::size_t stride, NumberType type, std::endian order,
                std::span<double> numbers);

/// A field of each row of a table.
struct ColumnLayout {
  std::string name;
  NumberType type = NumberType::kFloat32;
  std::uint32_t offset = 0;  ///< within the row [bytes]
  std::uint32_t count = 1;   ///< numbers one after the other
};

/// The first column of that name, or nullptr.
const ColumnLayout* find_column(std::span<const ColumnLayout> columns, std::string_view name);

/// Rows of numbers at a fixed stride: a point cloud's data, or an array of messages of fixed size.
/// Every column lies within the stride and every row within `bytes`; the last row may lack padding
/// that separates the others.
struct TableView {
  std::vector<ColumnLayout> columns;
  std::size_t stride = 0;  ///< from row to row [bytes]
  std::size_t rows = 0;
  std::span<const std::byte> bytes;
  std::endian order = std::endian::little;  ///< of the numbers

  /// The column of that name, or nullptr.
  const ColumnLayout* find(std::string_view name) const { return find_column(columns, name); }
};

}  // namespace aims
