// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "estimator/baselines/bievr/bump_image.hpp"
#include "estimator/lidar/voxel_store.hpp"

namespace aims::bievr {

/// A map of voxels with bump images.
class BumpMap {
 public:
  explicit BumpMap(const MapConfig& config) : config_(config) {}

  /// Adds the points of a scan. Beyond `max_voxels`, voxels not seen for longest are dropped.
  void insert(std::span<const MapPoint> points);

  /// Key of the voxel that holds a point [m].
  std::uint64_t key_of(const Eigen::Vector3d& p_world) const;
  /// The voxel of a key, or null where no surface was observed.
  const BumpVoxel* observed(std::uint64_t key) const;
  /// That of a point; where it has none, the one of its six neighbours whose centroid is nearest,
  /// or null.
  const BumpVoxel* nearest(const Eigen::Vector3d& p_world) const;

  std::size_t size() const { return store_.size(); }
  bool empty() const { return store_.empty(); }
  std::vector<Eigen::Vector3f> points() const;

 private:
  MapConfig config_;
  std::uint32_t insertions_ = 0;
  VoxelStore<BumpVoxel> store_;
};

}  // namespace aims::bievr
