// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <utility>
#include <vector>

namespace aims {

/// Fields of the points of a sensor_msgs/PointCloud2, as the ROS driver of a vendor lays them out.
enum class CloudLayout {
  kAims,      ///< as velodyne, with intensities from 0 to 1
  kVelodyne,  ///< velodyne_pointcloud
  kOuster,    ///< ouster-ros: one row per channel, misses included
  kHesai,     ///< HesaiLidar_ROS_2.0
  kLivox,     ///< livox_ros_driver2, PointXYZRTLT: every firing, misses included
};

/// Their names in configurations.
inline std::vector<std::pair<std::string, CloudLayout>> cloud_layout_names() {
  return {{"aims", CloudLayout::kAims},
          {"velodyne", CloudLayout::kVelodyne},
          {"ouster", CloudLayout::kOuster},
          {"hesai", CloudLayout::kHesai},
          {"livox", CloudLayout::kLivox}};
}

/// How the clouds of a sensor are written.
struct CloudFormat {
  CloudLayout layout = CloudLayout::kAims;
  int lines = 0;                  ///< channels, or lines of a rosette; for misses
  int columns = 0;                ///< firings of each in a scan; for misses
  double column_period_ns = 0.0;  ///< between them; for misses [ns]
};

}  // namespace aims
