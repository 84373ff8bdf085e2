// SPDX-License-Identifier: BSD-3-Clause
#include "estimator/lidar/point_choice.hpp"

namespace aims {

namespace {

/// Returns beyond this are no ranges of a LiDAR; indices of voxels stay small [m].
constexpr float kMaxRange = 1e4F;

}  // namespace

std::vector<int> chosen_points(const LidarScan& scan, int every_nth, double min_range) {
  std::vector<int> indices;
  const auto step = static_cast<std::size_t>(every_nth);
  const auto nearest = static_cast<float>(min_range);
  for (std::size_t i = 0; i < scan.points.size(); i += step) {
    const float range = scan.points[i].position.norm();
    if (range > nearest && range < kMaxRange) indices.push_back(static_cast<int>(i));
  }
  return indices;
}

}  // namespace aims
