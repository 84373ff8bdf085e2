// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "estimator/aims/config.hpp"
#include "estimator/lidar/plane_model.hpp"
#include "estimator/lidar/voxel_store.hpp"

namespace aims {

/// The map points nearest to a query, nearest first.
struct Neighbors {
  static constexpr int kWanted = 5;
  std::array<Eigen::Vector3f, kWanted> points;
  std::array<float, kWanted> squared_distances{};  ///< [m^2]
  int count = 0;
};

/// Local map: points in hashed cubic voxels. A return close to a map point merges into it (running
/// mean), so that noise averages out; memory is bounded per voxel and in all.
class VoxelMap {
 public:
  explicit VoxelMap(const MapConfig& config);

  /// Adds points in the odometry frame; non-finite ones are ignored. When there are too many
  /// voxels afterwards, those farthest from `center` are dropped. Voxels that are new remember the
  /// covariance `anchor` of the position from which they were first seen [m^2].
  void insert(std::span<const Eigen::Vector3f> points, const Eigen::Vector3f& center,
              const Eigen::Matrix3f& anchor = Eigen::Matrix3f::Zero());

  /// Forgets the voxels that none of the last `insertions` calls of `insert` put a point in.
  void forget_unseen(int insertions);

  /// The covariance that the voxel around `point` remembers; zero where there is none [m^2].
  Eigen::Matrix3f anchor_at(const Eigen::Vector3f& point) const;

  /// The up to five nearest map points within the gate (at most one voxel edge): exact.
  void nearest(const Eigen::Vector3f& query, Neighbors& neighbors) const;

  /// The plane through the five map points nearest to `query`; invalid when there is none.
  Plane plane_at(const Eigen::Vector3f& query) const;

  /// Memory that the map holds [bytes].
  std::size_t memory() const;

  std::size_t voxel_count() const { return voxels_.size(); }
  bool empty() const { return voxels_.empty(); }

  /// Every map point, in order of insertion of its voxel.
  std::vector<Eigen::Vector3f> points() const;

 private:
  static constexpr int kCapacity = 32;

  struct Voxel {
    alignas(16) std::array<float, kCapacity> x;
    std::array<float, kCapacity> y;
    std::array<float, kCapacity> z;
    std::array<std::uint8_t, kCapacity> merged;
    std::uint64_t key = 0;
    int count = 0;
    std::uint32_t seen = 0;  ///< the last insertion that put a point in it
    Eigen::Matrix3f anchor = Eigen::Matrix3f::Zero();
  };

  void insert(const Eigen::Vector3f& point, const Eigen::Matrix3f& anchor);
  static void search(const Voxel& voxel, const Eigen::Vector3f& query, float gate,
                     Neighbors& neighbors);

  MapConfig config_;
  float inverse_size_;
  float size_;
  float gate_;
  float spacing_;
  int max_points_per_voxel_;
  int max_merges_;
  std::size_t max_voxels_;
  VoxelStore<Voxel> voxels_;
};

}  // namespace aims
