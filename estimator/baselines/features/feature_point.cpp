// SPDX-License-Identifier: BSD-3-Clause
#include "estimator/baselines/features/feature_point.hpp"

#include <algorithm>
#include <cmath>

#include "estimator/lidar/voxel_hash.hpp"

namespace aims::features {

std::vector<FeatureCloud> ring_clouds(const LidarScan& scan, double min_range, double max_range) {
  std::vector<FeatureCloud> rings;
  const double duration = std::max(1.0, static_cast<double>(scan.end - scan.stamp));
  for (const LidarPoint& point : scan.points) {
    const double squared = point.position.cast<double>().squaredNorm();
    const bool in_range = squared >= min_range * min_range && squared <= max_range * max_range;
    if (!in_range || point.ring >= kMaxRings) continue;
    if (point.ring >= rings.size()) rings.resize(point.ring + 1U);
    const double fraction = std::clamp(point.time_offset_ns / duration, 0.0, 1.0);
    rings[point.ring].push_back({point.position, static_cast<float>(fraction), point.ring});
  }
  return rings;
}

FeatureCloud voxel_centroids(const FeatureCloud& cloud, double size) {
  FeatureCloud sums;
  std::vector<int> counts;
  VoxelHash voxels(cloud.size());
  const auto inverse_size = static_cast<float>(1.0 / size);
  for (const FeaturePoint& point : cloud) {
    const auto next = static_cast<std::int32_t>(sums.size());
    const std::int32_t slot =
        voxels.find_or_insert(voxel_key(voxel_of(point.position, inverse_size)), next);
    if (slot == next) {
      sums.push_back(point);
      counts.push_back(1);
      continue;
    }
    sums[slot].position += point.position;
    sums[slot].fraction += point.fraction;
    ++counts[slot];
  }
  for (std::size_t i = 0; i < sums.size(); ++i) {
    sums[i].position /= static_cast<float>(counts[i]);
    sums[i].fraction /= static_cast<float>(counts[i]);
  }
  return sums;
}

}  // namespace aims::features
