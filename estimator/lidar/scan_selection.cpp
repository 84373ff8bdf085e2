// SPDX-License-Identifier: BSD-3-Clause
#include "estimator/lidar/scan_selection.hpp"

namespace aims {
namespace {

/// Candidates between the prefetch of a table entry and its use: the table exceeds the caches.
constexpr std::size_t kAhead = 16;

/// Hash of an index (splitmix64 finalizer): chooses among the returns of a voxel.
std::uint64_t hash_of(std::int32_t index) {
  std::uint64_t bits = static_cast<std::uint64_t>(index) + 0x9e3779b97f4a7c15ULL;
  bits = (bits ^ (bits >> 30)) * 0xbf58476d1ce4e5b9ULL;
  bits = (bits ^ (bits >> 27)) * 0x94d049bb133111ebULL;
  return bits ^ (bits >> 31);
}

}  // namespace

bool ScanSelection::usable(const LidarPoint& point) const {
  const double squared = point.position.squaredNorm();
  return squared >= config_.min_range * config_.min_range &&  // false for a NaN
         squared <= config_.max_range * config_.max_range;
}

void ScanSelection::begin(const LidarScan& scan) {
  eligible_.clear();
  if (config_.leave_out_mixed) steps_.mark(scan);
  for (std::size_t i = 0; i < scan.points.size(); ++i) {
    if (!usable(scan.points[i]) || (config_.leave_out_mixed && steps_.mixed(i))) continue;
    eligible_.push_back(static_cast<std::int32_t>(i));
  }
}

void ScanSelection::list_candidates(const LidarScan& scan, double voxel) {
  candidates_.clear();
  const auto inverse_size = static_cast<float>(1.0 / voxel);
  for (const std::int32_t i : eligible_) {
    const Eigen::Vector3f& position = scan.points[static_cast<std::size_t>(i)].position;
    candidates_.push_back({voxel_key(voxel_of(position, inverse_size)), i});
  }
}

void ScanSelection::select(const LidarScan& scan, double voxel, int limit, std::vector<int>& kept) {
  kept.clear();
  occupied_.clear();
  list_candidates(scan, voxel);
  for (std::size_t i = 0; i < candidates_.size(); ++i) {
    if (i + kAhead < candidates_.size()) occupied_.prefetch(candidates_[i + kAhead].key);
    const auto next = static_cast<std::int32_t>(kept.size());
    const std::int32_t slot = occupied_.find_or_insert(candidates_[i].key, next);
    if (slot == next) {
      kept.push_back(candidates_[i].index);
    } else if (hash_of(candidates_[i].index) < hash_of(kept[slot])) {
      kept[slot] = candidates_[i].index;
    }
  }
  const std::size_t count = kept.size();
  const auto max_count = static_cast<std::size_t>(limit);
  if (count <= max_count) return;
  for (std::size_t i = 0; i < max_count; ++i) kept[i] = kept[i * count / max_count];
  kept.resize(max_count);
}

}  // namespace aims
