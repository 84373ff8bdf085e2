// SPDX-License-Identifier: BSD-3-Clause
#include "estimator/baselines/leg_kilo/scan_groups.hpp"

#include <algorithm>
#include <cmath>

#include "estimator/lidar/point_choice.hpp"

namespace aims::leg_kilo {

Time first_firing(const LidarScan& scan) {
  return scan.points.empty() ? scan.stamp : scan.stamp + scan.points.front().time_offset_ns;
}

Time last_firing(const LidarScan& scan) {
  return scan.points.empty() ? scan.end : scan.stamp + scan.points.back().time_offset_ns;
}

std::vector<TimedPoint> timed_points(const LidarScan& scan, const Points& config) {
  std::vector<TimedPoint> points;
  const Time begin = first_firing(scan);
  for (const int index : chosen_points(scan, config.every_nth, config.min_range)) {
    const LidarPoint& point = scan.points[static_cast<std::size_t>(index)];
    const double time = to_seconds(scan.stamp + point.time_offset_ns - begin);
    const double rounded = std::round(time / config.time_step) * config.time_step;
    points.emplace_back(point.position.x(), point.position.y(), point.position.z(),
                        static_cast<float>(rounded));
  }
  return points;
}

std::vector<PointGroup> point_groups(const LidarScan& scan, const Points& config) {
  std::vector<TimedPoint> points = voxel_centroids(timed_points(scan, config), config.voxel);
  std::ranges::stable_sort(points, {}, [](const TimedPoint& point) { return point.w(); });
  const Time begin = first_firing(scan);
  std::vector<PointGroup> groups;
  float time = 0.0F;
  for (const TimedPoint& point : points) {
    if (groups.empty() || point.w() != time)
      groups.push_back({begin + from_seconds(point.w()), {}});
    time = point.w();
    groups.back().points.push_back(point.head<3>().cast<double>());
  }
  return groups;
}

}  // namespace aims::leg_kilo
