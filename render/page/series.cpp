// SPDX-License-Identifier: BSD-3-Clause
#include "render/page/series.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace aims {

using Json = PageData::Json;

namespace {

bool has_number(const Numbers& values) {
  return std::any_of(values.begin(), values.end(), [](double v) { return !std::isnan(v); });
}

}  // namespace

std::vector<std::size_t> shown(std::size_t count) {
  const std::size_t stride = (count + kLongestSeries - 1) / kLongestSeries;
  std::vector<std::size_t> indices;
  for (std::size_t i = 0; i < count; i += stride) indices.push_back(i);
  if (count > 0) indices.back() = count - 1;
  return indices;
}

Json column(const Numbers& values, PageData& page, std::size_t components) {
  return has_number(values) ? page.q16(values, components) : Json();
}

Json stamp_column(const Numbers& values, PageData& page) {
  return has_number(values) ? page.f32(values) : Json();
}

Result<Numbers> numbers_at(const CsvColumns& table, const std::string& name,
                           const std::vector<std::ptrdiff_t>& rows) {
  const auto numbers = table.numbers(name);
  if (!numbers) return tl::unexpected(numbers.error());
  Numbers values(rows.size(), std::numeric_limits<double>::quiet_NaN());
  if (numbers->empty()) return values;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    if (rows[i] >= 0) values[i] = (*numbers)[static_cast<std::size_t>(rows[i])];
  }
  return values;
}

Result<void> add_columns(const CsvColumns& table, const ColumnNames& names,
                         const std::vector<std::ptrdiff_t>& rows, PageData& page, Json& json) {
  for (const auto& [key, name] : names) {
    const auto values = numbers_at(table, name, rows);
    if (!values) return tl::unexpected(values.error());
    json[key] = column(*values, page);
  }
  return {};
}

void append(const Eigen::Vector3d& v, Numbers& values) {
  values.insert(values.end(), {v.x(), v.y(), v.z()});
}

Json poses_json(const Trajectory& poses, double start, PageData& page) {
  Numbers t;
  Numbers p;
  Numbers q;
  for (const StampedPose& each : poses) {
    t.push_back(to_seconds(each.stamp) - start);
    append(each.pose.translation, p);
    const Eigen::Quaterniond& rotation = each.pose.rotation;
    q.insert(q.end(), {rotation.x(), rotation.y(), rotation.z(), rotation.w()});
  }
  return {{"t", stamp_column(t, page)}, {"p", column(p, page, 3)}, {"q", column(q, page, 4)}};
}

}  // namespace aims
