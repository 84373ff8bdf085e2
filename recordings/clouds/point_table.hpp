// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/error.hpp"
#include "core/time.hpp"
#include "recordings/messages/message_decoder.hpp"

namespace aims {

/// The points of one cloud message as rows of fields: a view into the message's bytes. Every field
/// of every row lies within `bytes`.
struct PointTable {
  Time stamp = 0;          ///< of the header
  std::string_view frame;  ///< of the header
  std::vector<ColumnLayout> columns;
  std::size_t width = 0;                    ///< points in a row
  std::size_t height = 1;                   ///< more than 1: an organised cloud
  std::size_t point_step = 0;               ///< [bytes]
  std::size_t row_step = 0;                 ///< [bytes]
  std::size_t padding = 0;                  ///< between points, which the last one may lack [bytes]
  std::endian order = std::endian::little;  ///< of the numbers
  std::optional<Time> time_base;            ///< origin of the points' times, if not the stamp
  std::span<const std::byte> bytes;

  std::size_t size() const { return width * height; }
  const std::byte* point(std::size_t index) const {
    return bytes.data() + (index / width) * row_step + (index % width) * point_step;
  }
  /// The first field of that name, or nullptr.
  const ColumnLayout* find(std::string_view name) const { return find_column(columns, name); }
  /// The first field with one of these names, or nullptr.
  const ColumnLayout* find_any(std::span<const std::string_view> names) const;
};

/// The points of a sensor_msgs/PointCloud2 or of a livox CustomMsg. Error for an inconsistent
/// layout: fields or rows beyond the data, or no x, y, z as float.
Result<PointTable> point_table(const MessageView& message);

/// Error unless rows, points and fields lie within the bytes and x, y, z exist.
Result<void> validate(const PointTable& table);

/// One field of every point.
class PointField {
 public:
  PointField(const PointTable& table, const ColumnLayout& column)
      : type_(column.type), offset_(column.offset), order_(table.order) {}

  double at(const std::byte* point) const { return number_at(point + offset_, type_, order_); }

  /// Replaces `numbers` by those of the points from `point`, `step` bytes apart.
  void read(const std::byte* point, std::size_t step, std::span<double> numbers) const {
    numbers_at(point + offset_, step, type_, order_, numbers);
  }

 private:
  NumberType type_;
  std::size_t offset_;
  std::endian order_;
};

}  // namespace aims
