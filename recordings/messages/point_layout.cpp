// SPDX-License-Identifier: BSD-3-Clause
#include "recordings/messages/point_layout.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>

namespace aims {
namespace {

// Types of sensor_msgs/PointField.
constexpr std::uint8_t kUint8 = 2;
constexpr std::uint8_t kUint16 = 4;
constexpr std::uint8_t kUint32 = 6;
constexpr std::uint8_t kFloat32 = 7;
constexpr std::uint8_t kFloat64 = 8;

constexpr std::array<PointFieldLayout, 6> kVelodyne = {{{"x", 0, kFloat32},
                                                        {"y", 4, kFloat32},
                                                        {"z", 8, kFloat32},
                                                        {"intensity", 12, kFloat32},
                                                        {"ring", 16, kUint16},
                                                        {"time", 18, kFloat32}}};
/// The fields of a struct of PCL, aligned to 16 bytes.
constexpr std::array<PointFieldLayout, 9> kOuster = {{{"x", 0, kFloat32},
                                                      {"y", 4, kFloat32},
                                                      {"z", 8, kFloat32},
                                                      {"intensity", 16, kFloat32},
                                                      {"t", 20, kUint32},
                                                      {"reflectivity", 24, kUint16},
                                                      {"ring", 26, kUint16},
                                                      {"ambient", 28, kUint16},
                                                      {"range", 32, kUint32}}};
constexpr std::array<PointFieldLayout, 6> kHesai = {{{"x", 0, kFloat32},
                                                     {"y", 4, kFloat32},
                                                     {"z", 8, kFloat32},
                                                     {"intensity", 12, kFloat32},
                                                     {"ring", 16, kUint16},
                                                     {"timestamp", 18, kFloat64}}};
constexpr std::array<PointFieldLayout, 7> kLivox = {{{"x", 0, kFloat32},
                                                     {"y", 4, kFloat32},
                                                     {"z", 8, kFloat32},
                                                     {"intensity", 12, kFloat32},
                                                     {"tag", 16, kUint8},
                                                     {"line", 17, kUint8},
                                                     {"timestamp", 18, kFloat64}}};

template <class Number>
void put(std::byte* point, std::size_t offset, Number value) {
  std::memcpy(point + offset, &value, sizeof(value));
}

void put_position(std::byte* bytes, const LidarPoint& point) {
  std::memcpy(bytes, point.position.data(), 12);
}

void put_velodyne(std::byte* bytes, const LidarPoint& point, float full_intensity) {
  put_position(bytes, point);
  put(bytes, 12, full_intensity * point.intensity);
  put(bytes, 16, point.ring);
  put(bytes, 18, static_cast<float>(point.time_offset_ns * 1e-9));
}

void put_ouster(std::byte* bytes, const LidarPoint& point, int rings) {
  const float reflectivity = 255.0F * point.intensity;
  put_position(bytes, point);
  put(bytes, 16, reflectivity);
  put(bytes, 20, static_cast<std::uint32_t>(std::max(0, point.time_offset_ns)));
  put(bytes, 24, static_cast<std::uint16_t>(std::lround(reflectivity)));
  put(bytes, 26, static_cast<std::uint16_t>(rings - 1 - point.ring));
  put(bytes, 32, static_cast<std::uint32_t>(std::lround(1e3 * point.position.norm())));
}

void put_hesai(std::byte* bytes, const LidarPoint& point, Time stamp, int rings) {
  put_position(bytes, point);
  put(bytes, 12, 255.0F * point.intensity);
  put(bytes, 16, static_cast<std::uint16_t>(rings - 1 - point.ring));
  put(bytes, 18, to_seconds(stamp + point.time_offset_ns));
}

void put_livox(std::byte* bytes, const LidarPoint& point, Time stamp) {
  put_position(bytes, point);
  put(bytes, 12, 255.0F * point.intensity);
  put(bytes, 17, static_cast<std::uint8_t>(point.ring));
  put(bytes, 18, static_cast<double>(stamp + point.time_offset_ns));
}

/// A block of one row with the scan's points.
template <class Put>
PointBlock row_of_points(const LidarScan& scan, std::uint32_t point_step, const Put& put_point) {
  PointBlock block{1, static_cast<std::uint32_t>(scan.points.size()), {}};
  block.bytes.resize(scan.points.size() * point_step);
  std::byte* next = block.bytes.data();
  for (const LidarPoint& point : scan.points) {
    put_point(next, point);
    next += point_step;
  }
  return block;
}

/// A point that no firing gave.
LidarPoint miss(int ring, double time_offset_ns) {
  LidarPoint point;
  point.ring = static_cast<std::uint16_t>(ring);
  point.time_offset_ns = static_cast<std::int32_t>(std::lround(time_offset_ns));
  return point;
}

int nearest_index(double time_offset_ns, double interval_ns, int count) {
  return std::clamp(static_cast<int>(std::lround(time_offset_ns / interval_ns)), 0, count - 1);
}

PointBlock ouster_block(const LidarScan& scan, const CloudFormat& format) {
  const std::uint32_t step = point_layout(CloudLayout::kOuster).point_step;
  PointBlock block{
      static_cast<std::uint32_t>(format.lines), static_cast<std::uint32_t>(format.columns), {}};
  block.bytes.resize(std::size_t{block.height} * block.width * step);
  const auto at = [&](int ring, int column) {
    const std::size_t row = static_cast<std::size_t>(format.lines - 1 - ring);
    return block.bytes.data() + (row * block.width + static_cast<std::size_t>(column)) * step;
  };
  for (int ring = 0; ring < format.lines; ++ring) {
    for (int column = 0; column < format.columns; ++column) {
      put_ouster(at(ring, column), miss(ring, column * format.column_period_ns), format.lines);
    }
  }
  for (const LidarPoint& point : scan.points) {
    if (point.ring >= format.lines) continue;
    const int column = nearest_index(point.time_offset_ns, format.column_period_ns, format.columns);
    put_ouster(at(point.ring, column), point, format.lines);
  }
  return block;
}

PointBlock livox_block(const LidarScan& scan, const CloudFormat& format) {
  const std::uint32_t step = point_layout(CloudLayout::kLivox).point_step;
  const int firings = format.lines * format.columns;
  const double interval_ns = format.column_period_ns / format.lines;
  PointBlock block{1, static_cast<std::uint32_t>(firings), {}};
  block.bytes.resize(static_cast<std::size_t>(firings) * step);
  const auto at = [&](int firing) {
    return block.bytes.data() + static_cast<std::size_t>(firing) * step;
  };
  for (int firing = 0; firing < firings; ++firing) {
    put_livox(at(firing), miss(firing % format.lines, firing * interval_ns), scan.stamp);
  }
  for (const LidarPoint& point : scan.points) {
    put_livox(at(nearest_index(point.time_offset_ns, interval_ns, firings)), point, scan.stamp);
  }
  return block;
}

}  // namespace

PointLayout point_layout(CloudLayout layout) {
  switch (layout) {
    case CloudLayout::kAims:
    case CloudLayout::kVelodyne:
      return {"velodyne_pointcloud", kVelodyne, 22};
    case CloudLayout::kOuster:
      return {"ouster-ros", kOuster, 48};
    case CloudLayout::kHesai:
      return {"HesaiLidar_ROS_2.0", kHesai, 26};
    case CloudLayout::kLivox:
      return {"livox_ros_driver2", kLivox, 26};
  }
  return {};
}

PointBlock point_block(const LidarScan& scan, const CloudFormat& format) {
  const std::uint32_t step = point_layout(format.layout).point_step;
  switch (format.layout) {
    case CloudLayout::kAims:
    case CloudLayout::kVelodyne: {
      const float full = format.layout == CloudLayout::kAims ? 1.0F : 100.0F;
      return row_of_points(scan, step, [&](std::byte* bytes, const LidarPoint& point) {
        put_velodyne(bytes, point, full);
      });
    }
    case CloudLayout::kOuster:
      return ouster_block(scan, format);
    case CloudLayout::kHesai:
      return row_of_points(scan, step, [&](std::byte* bytes, const LidarPoint& point) {
        put_hesai(bytes, point, scan.stamp, format.lines);
      });
    case CloudLayout::kLivox:
      return livox_block(scan, format);
  }
  return {};
}

}  // namespace aims
