// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "estimator/lidar/lidar_config.hpp"
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

/// The nearest of the points offered, nearest first; of equal ones those offered earlier.
class NearestPoints {
 public:
  /// Points up to the squared distance `gate` [m^2] count.
  explicit NearestPoints(float gate) { keys_.fill(key(gate, kNone)); }

  /// Offers a point; each needs an `id` above those before.
  void offer(float squared_distance, std::uint32_t id) {
    std::uint64_t rest = key(squared_distance, id);
    if (rest >= keys_.back()) return;
    for (std::uint64_t& each : keys_) {  // insertion without branches
      const std::uint64_t nearer = std::min(each, rest);
      rest = std::max(each, rest);
      each = nearer;
    }
  }

  /// Points farther than this have no effect [m^2].
  float reach() const { return squared_distance(Neighbors::kWanted - 1); }

  int count() const {
    int count = 0;
    while (count < Neighbors::kWanted && id(count) != kNone) ++count;
    return count;
  }
  std::uint32_t id(int k) const { return static_cast<std::uint32_t>(keys_[k]); }
  float squared_distance(int k) const {
    return std::bit_cast<float>(static_cast<std::uint32_t>(keys_[k] >> 32U));
  }

 private:
  static constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();

  /// Ordered by distance, then id: floats that are not negative have the order of their bits.
  static std::uint64_t key(float squared_distance, std::uint32_t id) {
    return (std::uint64_t{std::bit_cast<std::uint32_t>(squared_distance)} << 32U) | id;
  }

  std::array<std::uint64_t, Neighbors::kWanted> keys_;
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

  /// The nearest points of each half, up to five, within one voxel edge; exact. Returns how many
  /// voxels it took.
  int nearest(const Eigen::Vector3f& query, std::array<Neighbors, kHalves>& neighbors) const;

  /// The planes at `query`, through the five nearest points of each half; invalid where these are
  /// fewer, span no plane, or lie beside the query.
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

  /// Four points side by side, so that one instruction takes all.
  struct alignas(16) FourPoints {
    std::array<float, 4> x{};
    std::array<float, 4> y{};
    std::array<float, 4> z{};
  };
  struct Half {
    int count = 0;
    std::array<FourPoints, kCapacity / 4> points;
    std::array<std::uint8_t, kCapacity> merged{};

    Eigen::Vector3f point(int i) const;
    void set(int i, const Eigen::Vector3f& point);
  };
  using SquaredDistances = std::array<float, kCapacity>;

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
  static SquaredDistances squared_distances(const Half& half, const Eigen::Vector3f& query);
  static void search(const Half& half, const Eigen::Vector3f& query, std::uint32_t voxel,
                     NearestPoints& nearest);

  float inverse_size_;
  float size_;
  float spacing_;
  std::size_t max_voxels_;
  std::size_t half_ = 0;  ///< of the next insertion
  int in_block_ = 0;      ///< insertions in the present block
  int block_ = 1;         ///< its length
  VoxelStore<Voxel> voxels_;
};

}  // namespace aims
