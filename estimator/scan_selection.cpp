// SPDX-License-Identifier: BSD-3-Clause
#include "estimator/scan_selection.hpp"

namespace aims {

bool ScanSelection::usable(const LidarPoint& point) const {
  const double squared = point.position.squaredNorm();
  return squared >= config_.min_range * config_.min_range &&  // false for a NaN
         squared <= config_.max_range * config_.max_range;
}

void ScanSelection::select(const LidarScan& scan, double voxel, int limit, std::vector<int>& kept) {
  kept.clear();
  taken_.clear();
  const auto inverse_size = static_cast<float>(1.0 / voxel);
  for (std::size_t i = 0; i < scan.points.size(); ++i) {
    if (!usable(scan.points[i])) continue;
    const std::uint64_t key = voxel_key(voxel_of(scan.points[i].position, inverse_size));
    const auto index = static_cast<std::int32_t>(i);
    if (taken_.find_or_insert(key, index) == index) kept.push_back(index);
  }
  const std::size_t count = kept.size();
  const auto most = static_cast<std::size_t>(limit);
  if (count <= most) return;
  for (std::size_t i = 0; i < most; ++i) kept[i] = kept[i * count / most];
  kept.resize(most);
}

}  // namespace aims
