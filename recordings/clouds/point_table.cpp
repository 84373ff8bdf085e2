// SPDX-License-Identifier: BSD-3-Clause
#include "recordings/clouds/point_table.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace aims {
namespace {

constexpr std::size_t kMaxFields = 256;
/// sensor_msgs/PointField: 1 to 8.
constexpr std::array<NumberType, 8> kPointFieldTypes = {
    NumberType::kInt8,  NumberType::kUint8,  NumberType::kInt16,   NumberType::kUint16,
    NumberType::kInt32, NumberType::kUint32, NumberType::kFloat32, NumberType::kFloat64};

/// A size in a message, or nothing.
std::optional<std::size_t> size_at(const MessageView& message, std::string_view path) {
  const std::optional<double> value = message.number(path);
  if (!value || !(*value >= 0.0) || *value > 4294967295.0) return std::nullopt;
  return static_cast<std::size_t>(*value);
}

Result<std::vector<ColumnLayout>> point_fields(const MessageView& message) {
  const std::size_t count = message.size("fields").value_or(0);
  if (count > kMaxFields) return failure(fmt::format("point cloud with {} fields", count));
  std::vector<ColumnLayout> columns;
  for (std::size_t i = 0; i < count; ++i) {
    const std::string field = fmt::format("fields[{}].", i);
    const auto name = message.text(field + "name");
    const auto offset = size_at(message, field + "offset");
    const auto type = size_at(message, field + "datatype");
    const auto numbers = size_at(message, field + "count");
    if (!name || !offset || !type || !numbers) return failure("point cloud without field layouts");
    if (*type < 1 || *type > kPointFieldTypes.size()) {
      return failure(fmt::format("point field '{}' of unknown type {}", *name, *type));
    }
    columns.push_back({std::string(*name), kPointFieldTypes[*type - 1],
                       static_cast<std::uint32_t>(*offset), static_cast<std::uint32_t>(*numbers)});
  }
  return columns;
}

Result<PointTable> generic_table(const MessageView& message) {
  const auto width = size_at(message, "width");
  const auto height = size_at(message, "height");
  const auto point_step = size_at(message, "point_step");
  const auto row_step = size_at(message, "row_step");
  const auto data = message.bytes("data");
  if (!width || !height || !point_step || !row_step || !data) {
    return failure("neither a PointCloud2 nor a livox CustomMsg");
  }
  auto columns = point_fields(message);
  if (!columns) return tl::unexpected(columns.error());
  PointTable table;
  table.columns = std::move(*columns);
  table.width = *width;
  table.height = *height;
  table.point_step = *point_step;
  // Some writers leave the row step at 0 when there is only one row.
  table.row_step = *row_step == 0 ? *width * *point_step : *row_step;
  if (message.number("is_bigendian").value_or(0.0) != 0.0) table.order = std::endian::big;
  table.bytes = *data;
  return table;
}

PointTable livox_table(const MessageView& message, const TableView& points) {
  PointTable table;
  table.columns = points.columns;
  table.width = points.rows;
  table.point_step = points.stride;
  table.row_step = points.rows * points.stride;
  table.padding = table.row_step - points.bytes.size();
  table.order = points.order;
  table.bytes = points.bytes;
  const double base = message.number("timebase").value_or(0.0);
  if (base > 0.0 && base < 9e18) table.time_base = static_cast<Time>(base);
  return table;
}

Result<void> validate_position(const PointTable& table) {
  std::array<const ColumnLayout*, 3> axes{};
  constexpr std::array<std::string_view, 3> kNames = {"x", "y", "z"};
  for (std::size_t i = 0; i < 3; ++i) {
    axes[i] = table.find(kNames[i]);
    if (axes[i] == nullptr) {
      std::string names;
      for (const ColumnLayout& column : table.columns) names += ' ' + column.name;
      return failure(fmt::format("point cloud without field '{}'; it has:{}", kNames[i], names));
    }
    if (axes[i]->type != NumberType::kFloat32 && axes[i]->type != NumberType::kFloat64) {
      return failure(fmt::format("point field '{}' is not float32 or float64", kNames[i]));
    }
    for (std::size_t j = 0; j < i; ++j) {
      const std::size_t low = std::min(axes[i]->offset, axes[j]->offset);
      const std::size_t high = std::max(axes[i]->offset, axes[j]->offset);
      if (high - low < 4) {
        return failure(fmt::format("point fields '{}' and '{}' overlap", kNames[j], kNames[i]));
      }
    }
  }
  return {};
}

}  // namespace

const ColumnLayout* PointTable::find_any(std::span<const std::string_view> names) const {
  for (const std::string_view name : names) {
    if (const ColumnLayout* column = find(name)) return column;
  }
  return nullptr;
}

Result<void> validate(const PointTable& table) {
  if (auto ok = validate_position(table); !ok) return ok;
  for (const ColumnLayout& column : table.columns) {
    const std::size_t numbers = std::max<std::size_t>(column.count, 1);
    if (column.offset > table.point_step ||
        numbers > (table.point_step - column.offset) / size_of(column.type) ||
        column.offset + numbers * size_of(column.type) > table.point_step - table.padding) {
      return failure(fmt::format("point field '{}' at {} lies beyond the point's {} bytes",
                                 column.name, column.offset, table.point_step));
    }
  }
  if (table.width == 0 || table.height == 0) return {};
  const std::size_t size = table.bytes.size() + table.padding;
  if (table.width > size / table.point_step || table.row_step < table.width * table.point_step ||
      table.row_step > size || table.height - 1 > size ||
      (table.height - 1) * table.row_step + table.width * table.point_step > size) {
    return failure(fmt::format(
        "{} x {} points of {} bytes, rows of {}: more than the {} bytes of data", table.width,
        table.height, table.point_step, table.row_step, table.bytes.size()));
  }
  return {};
}

Result<PointTable> point_table(const MessageView& message) {
  Result<PointTable> table = failure("");
  if (const auto points = message.table("points")) {
    table = livox_table(message, *points);
  } else {
    table = generic_table(message);
    if (!table) return table;
  }
  table->stamp = message.time("header.stamp").value_or(0);
  table->frame = message.text("header.frame_id").value_or(std::string_view());
  if (auto ok = validate(*table); !ok) return tl::unexpected(ok.error());
  return table;
}

}  // namespace aims
