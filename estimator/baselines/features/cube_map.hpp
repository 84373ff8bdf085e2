// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <map>
#include <vector>

#include "estimator/baselines/features/feature_point.hpp"

namespace aims::features {

/// Map points in cubes. The points of a cube are averaged in voxels whenever some are added: an
/// average weighs as much as a new point, so that the map follows the newest scans.
class CubeMap {
 public:
  /// Edges of cubes and voxels [m].
  CubeMap(double cube_size, double voxel_size) : cube_size_(cube_size), voxel_size_(voxel_size) {}

  /// Adds points in map axes.
  void insert(const FeatureCloud& points);

  /// The points of the cubes around `position`: two on each side, one below and above.
  std::vector<Eigen::Vector3f> around(const Eigen::Vector3d& position) const;

  /// All points.
  std::vector<Eigen::Vector3f> points() const;

 private:
  using CubeIndex = std::array<std::int64_t, 3>;
  CubeIndex cube_of(const Eigen::Vector3d& position) const;

  double cube_size_;
  double voxel_size_;
  std::map<CubeIndex, FeatureCloud> cubes_;
};

}  // namespace aims::features
