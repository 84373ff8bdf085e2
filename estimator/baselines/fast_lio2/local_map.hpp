// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <span>

#include "estimator/baselines/fast_lio2/config.hpp"
#include "estimator/baselines/fast_lio2/point_map.hpp"

namespace aims::fast_lio2 {

/// Whether and how the map takes a point.
enum class Insertion {
  kNone,       ///< a neighbour is nearer to the centre of the point's voxel
  kVoxel,      ///< one point of the voxel stays
  kUnchecked,  ///< the nearest map point is outside the voxel along every axis
};

/// The decision for `point` (world), of which `neighbours` were found before its last correction.
Insertion insertion_of(const Eigen::Vector3f& point, const Neighbours& neighbours,
                       const PointMap& map, double voxel);

/// The cube around the LiDAR that the map keeps.
class LocalCube {
 public:
  explicit LocalCube(const Map& config) : config_(config) {}

  /// Moves the cube when the LiDAR at `position` (world) [m] comes near a face, and removes what
  /// it left behind from the map.
  void follow(const Eigen::Vector3d& position, PointMap& map);

 private:
  Map config_;
  std::optional<Box> cube_;
};

/// Inserts the points of a scan (world), each with its neighbours: first those that compete for
/// their voxel, then those that do not.
void insert_scan(std::span<const Eigen::Vector3f> points, std::span<const Neighbours> neighbours,
                 double voxel, PointMap& map);

}  // namespace aims::fast_lio2
