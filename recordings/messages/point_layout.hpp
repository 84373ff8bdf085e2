// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

#include "core/cloud_layout.hpp"
#include "core/measurements.hpp"

namespace aims {

/// One field of a point, as sensor_msgs/PointField states it.
struct PointFieldLayout {
  std::string_view name;
  std::uint32_t offset = 0;  ///< [bytes]
  std::uint8_t type = 0;     ///< of sensor_msgs/PointField
};

/// The points of a cloud as a driver writes them.
struct PointLayout {
  std::string_view driver;
  std::span<const PointFieldLayout> fields;
  std::uint32_t point_step = 0;  ///< [bytes]
};

PointLayout point_layout(CloudLayout layout);

/// The points of a sensor_msgs/PointCloud2.
struct PointBlock {
  std::uint32_t height = 1;
  std::uint32_t width = 0;
  std::vector<std::byte> bytes;  ///< little endian, rows one after the other
};

/// The scan's points in that layout. Intensities go from 0 to 1 (aims), 100 (velodyne) or 255.
/// Rings are numbered from the lowest (aims, velodyne) or from the highest (ouster, hesai); lines
/// of a rosette stay. Times: float32 [s] after the stamp (aims, velodyne), uint32 [ns] after it
/// (ouster), float64 of the clock of the stamps, [s] (hesai) or [ns] (livox). With misses, ouster
/// has a row per ring from the highest and a column per firing, livox every firing; a miss is at
/// the origin.
PointBlock point_block(const LidarScan& scan, const CloudFormat& format);

}  // namespace aims
