// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <array>
#include <span>
#include <vector>

#include "estimator/aims/config.hpp"
#include "estimator/lidar/plane_model.hpp"
#include "estimator/lidar/voxel_store.hpp"

namespace aims {

/// Planes of cubic voxels, each from the running sums of the returns in it, fitted anew only when
/// enough returns came (cf. Yuan et al. 2022). Two levels, of the map's voxel and half of it: where
/// the coarse voxel holds no plane, the fine one may.
class PlaneVoxels {
 public:
  explicit PlaneVoxels(const MapConfig& config);

  /// Adds finite points in the odometry frame. When there are too many voxels of a level
  /// afterwards, those farthest from `center` are dropped.
  void insert(std::span<const Eigen::Vector3f> points, const Eigen::Vector3f& center);

  /// The plane of the coarsest voxel around `query` that holds one; invalid when none does.
  const Plane& plane_at(const Eigen::Vector3f& query) const;

  /// Forgets the voxels that none of the last `insertions` calls of `insert` put a point in.
  void forget_unseen(int insertions);

  /// Memory that the voxels hold [bytes].
  std::size_t memory() const;

  /// Voxels of all levels.
  std::size_t voxel_count() const;

 private:
  static constexpr int kLevels = 2;

  struct Voxel {
    std::uint64_t key = 0;
    Eigen::Vector3d origin;  ///< its first point: sums are kept relative to it [m]
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    Eigen::Matrix3d squares = Eigen::Matrix3d::Zero();
    int count = 0;
    std::uint32_t seen = 0;  ///< the last insertion that put a point in it
    mutable int fitted = 0;  ///< points at the last fit
    mutable Plane plane;
  };

  struct Level {
    float inverse_size = 2.0F;
    double min_spread = 0.0;  ///< second principal deviation of its points [m]
    VoxelStore<Voxel> voxels;
  };

  void insert(Level& level, const Eigen::Vector3f& point) const;
  void fit(const Voxel& voxel, double min_spread) const;

  MapConfig config_;
  std::array<Level, kLevels> levels_;
  Plane none_;
};

}  // namespace aims
