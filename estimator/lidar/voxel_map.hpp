// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "estimator/lidar/lidar_config.hpp"
#include "estimator/lidar/plane_grid.hpp"
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

/// Local map: points in hashed cubic voxels, in two halves that share no return, so that the noise
/// of their planes is independent. A return close to a map point of its half merges into it
/// (running mean), which averages noise; memory is bounded per voxel and in total.
class VoxelMap {
 public:
  explicit VoxelMap(const MapConfig& config);

  /// Adds points in the odometry frame; non-finite ones are ignored. When there are too many
  /// voxels afterwards, those farthest from `center` are dropped. New voxels store `covariance`,
  /// that of the position from which they are mapped [m^2].
  void insert(std::span<const Eigen::Vector3f> points, const Eigen::Vector3f& center,
              const Eigen::Matrix3f& covariance = Eigen::Matrix3f::Zero());

  /// The covariance stored in the voxel around `point`; zero where there is none [m^2].
  Eigen::Matrix3f covariance_at(const Eigen::Vector3f& point) const;

  /// The nearest points of each half, up to five, within one voxel edge; exact.
  void nearest(const Eigen::Vector3f& query, std::array<Neighbors, kHalves>& neighbors) const;

  /// The planes at `query`: of the largest cell around it whose returns lie on one in both halves,
  /// else through the five nearest points of each half; invalid without them.
  PlanePair planes_at(const Eigen::Vector3f& query) const;

  /// Memory that the map holds [bytes].
  std::size_t memory() const;

  std::size_t voxel_count() const { return voxels_.size(); }
  bool empty() const { return voxels_.empty(); }

  /// Every map point, in order of insertion of its voxel.
  std::vector<Eigen::Vector3f> points() const;

 private:
  static constexpr int kCapacity = 32;   ///< points of one half in a voxel
  static constexpr int kMaxMerges = 20;  ///< returns averaged by a map point
  /// Consecutive insertions into one half: 2 s of scans at 10 Hz. Scans of one stride share the
  /// error of the pose from which they are mapped, and with it the tilt of their planes.
  static constexpr int kLongestBlock = 20;

  struct Half {
    alignas(16) std::array<float, kCapacity> x;
    std::array<float, kCapacity> y;
    std::array<float, kCapacity> z;
    std::array<std::uint8_t, kCapacity> merged;
    int count = 0;
  };

  struct Voxel {
    std::array<Half, kHalves> halves;
    std::uint64_t key = 0;
    Eigen::Vector3f first = Eigen::Vector3f::Zero();  ///< its first point
    bool empty = true;
    std::uint32_t seen = 0;  ///< the last insertion that put a point in it
    Eigen::Matrix3f covariance = Eigen::Matrix3f::Zero();
  };

  void insert(const Eigen::Vector3f& point, std::size_t half, const Eigen::Matrix3f& covariance);
  void end_insertion();
  void insert(const Eigen::Vector3f& point, Half& half) const;
  static void search(const Half& half, const Eigen::Vector3f& query, float gate,
                     Neighbors& neighbors);

  float inverse_size_;
  float size_;
  float spacing_;
  std::size_t max_voxels_;
  std::size_t half_ = 0;  ///< of the next insertion
  int in_block_ = 0;      ///< insertions in the present block
  int block_ = 1;         ///< its length
  VoxelStore<Voxel> voxels_;
  std::vector<PlaneGrid> grids_;  ///< coarse to fine
};

}  // namespace aims
