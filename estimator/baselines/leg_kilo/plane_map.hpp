// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "estimator/baselines/leg_kilo/observations.hpp"
#include "estimator/baselines/leg_kilo/voxel_plane.hpp"
#include "estimator/lidar/voxel_store.hpp"

namespace aims::leg_kilo {

/// The map: a grid of voxels, each with the planes of its points.
class PlaneMap {
 public:
  explicit PlaneMap(const Map& config) : config_(config) {}

  bool empty() const { return voxels_.empty(); }

  /// The plane that a point lies on with the greatest probability, in the point's voxel or, without
  /// one there, in a neighbouring voxel; empty when it lies on none.
  std::optional<PointOnPlane> match(const ScanPoint& point, const Residuals& config) const;

  /// Adds the points of the first scan, then fits their planes.
  void build(std::span<const MapPoint> points);

  /// Adds points one after the other.
  void add(std::span<const MapPoint> points);

  /// Drops the farthest voxels from `position` [m] when there are too many.
  void limit(const Eigen::Vector3d& position);

  /// Centres of the planes [m].
  std::vector<Eigen::Vector3f> plane_centres() const;

 private:
  struct Voxel {
    std::uint64_t key = 0;
    std::uint32_t seen = 0;
    std::optional<PlaneTree> planes;
  };

  PlaneTree& planes_at(const Eigen::Vector3d& point);
  std::optional<PointOnPlane> match_in(const Voxel& voxel, const ScanPoint& point,
                                       const Residuals& config) const;

  Map config_;
  VoxelStore<Voxel> voxels_;
};

}  // namespace aims::leg_kilo
