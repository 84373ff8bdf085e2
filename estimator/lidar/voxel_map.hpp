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

#include "estimator/lidar/four_points.hpp"
#include "estimator/lidar/lidar_config.hpp"
#include "estimator/lidar/nearest_points.hpp"
#include "estimator/lidar/plane_model.hpp"
#include "estimator/lidar/voxel_store.hpp"

namespace aims {

/// The map points nearest to a query, nearest first.
struct Neighbors {
  static constexpr int kWanted = NearestPoints::kWanted;
  std::array<Eigen::Vector3f, kWanted> points;
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
  static constexpr std::size_t kNeighborhood = 27;  ///< a voxel and those around it
  /// Their places, itself first: four for each step along x and y, of which the last one is none.
  static constexpr std::size_t kPlaces = 36;
  static constexpr std::int32_t kNone = VoxelHash::kNone;
  static constexpr float kFar = 1e12F;  ///< [m]
  static constexpr int kCapacity = 32;  ///< points of one half in a voxel
  static constexpr std::uint32_t kGroups = kCapacity / 4;
  static_assert(kNeighborhood * kGroups <= NearestPoints::kMaxGroups);
  static constexpr int kMaxMerges = 20;  ///< returns averaged by a map point
  /// Consecutive insertions into one half: 2 s of scans at 10 Hz. Scans of one stride share the
  /// error of the pose from which they are mapped, and with it the tilt of their planes.
  static constexpr int kLongestBlock = 20;

  struct Half {
    Half() { points.fill(FourPoints::all(kFar)); }

    int count = 0;
    std::array<FourPoints, kCapacity / 4> points;  ///< the missing ones are far away
    std::array<std::uint8_t, kCapacity> merged{};

    Eigen::Vector3f point(int i) const;
    void set(int i, const Eigen::Vector3f& point);
    void remove(int i);
  };

  struct Voxel {
    void link(std::size_t place, std::int32_t index) {
      linked |= std::uint64_t{1} << place;
      around[place] = index;
    }

    std::uint64_t key = 0;
    Eigen::Vector3f first = Eigen::Vector3f::Zero();  ///< its first point
    bool empty = true;
    std::uint32_t seen = 0;                      ///< the last insertion that put a point in it
    std::uint64_t linked = 0;                    ///< bit i: there is a voxel at place i
    std::array<std::int32_t, kPlaces> around{};  ///< their indices
    std::array<Half, kHalves> halves;
    Eigen::Matrix3f covariance = Eigen::Matrix3f::Zero();
  };
  /// The voxels at and around a point.
  class Surroundings;

  /// A map point of the half that is being inserted into.
  struct Place {
    std::int32_t voxel = kNone;  ///< index
    int point = 0;
  };
  struct Search;

  void insert(const Eigen::Vector3f& point, const Eigen::Matrix3f& covariance);
  void end_insertion();
  Place nearest_within_spacing(const Eigen::Vector3f& point);
  static VoxelIndex neighbor(const VoxelIndex& voxel, std::size_t place);
  static std::size_t opposite(std::size_t place);
  void link(Voxel& voxel);
  void merge(const Eigen::Vector3f& point, const Place& into, const Eigen::Matrix3f& covariance);
  void add(const Eigen::Vector3f& point, std::uint8_t merged, const Eigen::Matrix3f& covariance);

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
