// SPDX-License-Identifier: BSD-3-Clause
#include "estimator/baselines/bievr/bump_map.hpp"

#include <algorithm>
#include <limits>

namespace aims::bievr {
namespace {

/// A point and the voxel that holds it.
struct Placed {
  std::uint64_t key = 0;
  MapPoint point;
};

}  // namespace

std::uint64_t BumpMap::key_of(const Eigen::Vector3d& p_world) const {
  return voxel_key(voxel_of(p_world.cast<float>(), static_cast<float>(1.0 / config_.voxel)));
}

void BumpMap::insert(std::span<const MapPoint> points) {
  std::vector<Placed> placed;
  placed.reserve(points.size());
  for (const MapPoint& point : points) placed.push_back({key_of(point.p_world), point});
  std::ranges::stable_sort(placed, {}, &Placed::key);
  store_.begin_insertion();
  ++insertions_;
  std::vector<MapPoint> of_voxel;
  for (std::size_t begin = 0; begin < placed.size();) {
    const std::uint64_t key = placed[begin].key;
    of_voxel.clear();
    std::size_t end = begin;
    for (; end < placed.size() && placed[end].key == key; ++end) {
      of_voxel.push_back(placed[end].point);
    }
    const Eigen::Vector3d corner =
        (of_voxel.front().p_world / config_.voxel).array().floor() * config_.voxel;
    store_.touch(key).add(of_voxel, corner, config_);
    begin = end;
  }
  store_.limit(static_cast<std::size_t>(config_.max_voxels),
               [&](const BumpVoxel& voxel) { return insertions_ - voxel.seen; });
}

const BumpVoxel* BumpMap::observed(std::uint64_t key) const {
  const BumpVoxel* voxel = store_.find(key);
  return voxel != nullptr && voxel->observed ? voxel : nullptr;
}

const BumpVoxel* BumpMap::nearest(const Eigen::Vector3d& p_world) const {
  if (const BumpVoxel* own = observed(key_of(p_world))) return own;
  const BumpVoxel* best = nullptr;
  double least = std::numeric_limits<double>::infinity();
  for (int side = 0; side < 6; ++side) {
    const double offset = side % 2 == 0 ? config_.voxel : -config_.voxel;
    const BumpVoxel* each = observed(key_of(p_world + offset * Eigen::Vector3d::Unit(side / 2)));
    if (each == nullptr) continue;
    const double distance = (p_world - each->centroid()).squaredNorm();
    if (distance < least) {
      least = distance;
      best = each;
    }
  }
  return best;
}

std::vector<Eigen::Vector3f> BumpMap::points() const {
  std::vector<Eigen::Vector3f> points;
  for (const BumpVoxel& voxel : store_) {
    if (voxel.observed) voxel.image.append_points(points);
  }
  return points;
}

}  // namespace aims::bievr
