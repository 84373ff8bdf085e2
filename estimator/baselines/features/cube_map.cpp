// SPDX-License-Identifier: BSD-3-Clause
#include "estimator/baselines/features/cube_map.hpp"

#include <cmath>
#include <set>

namespace aims::features {
namespace {

// Cubes around the LiDAR's that are matched, as published.
constexpr std::int64_t kReach = 2;
constexpr std::int64_t kVerticalReach = 1;

void append(const FeatureCloud& cloud, std::vector<Eigen::Vector3f>& points) {
  for (const FeaturePoint& point : cloud) points.push_back(point.position);
}

}  // namespace

/// Cube 0 is centred on the origin.
CubeMap::CubeIndex CubeMap::cube_of(const Eigen::Vector3d& position) const {
  CubeIndex index;
  for (int i = 0; i < 3; ++i) index[i] = std::llround(std::floor(position[i] / cube_size_ + 0.5));
  return index;
}

void CubeMap::insert(const FeatureCloud& points) {
  std::set<CubeIndex> changed;
  for (const FeaturePoint& point : points) {
    const CubeIndex index = cube_of(point.position.cast<double>());
    cubes_[index].push_back(point);
    changed.insert(index);
  }
  for (const CubeIndex& index : changed) {
    FeatureCloud& cube = cubes_[index];
    cube = voxel_centroids(cube, voxel_size_);
  }
}

std::vector<Eigen::Vector3f> CubeMap::around(const Eigen::Vector3d& position) const {
  std::vector<Eigen::Vector3f> points;
  const CubeIndex centre = cube_of(position);
  for (std::int64_t x = -kReach; x <= kReach; ++x) {
    for (std::int64_t y = -kReach; y <= kReach; ++y) {
      for (std::int64_t z = -kVerticalReach; z <= kVerticalReach; ++z) {
        const auto cube = cubes_.find({centre[0] + x, centre[1] + y, centre[2] + z});
        if (cube != cubes_.end()) append(cube->second, points);
      }
    }
  }
  return points;
}

std::vector<Eigen::Vector3f> CubeMap::points() const {
  std::vector<Eigen::Vector3f> points;
  for (const auto& [index, cube] : cubes_) append(cube, points);
  return points;
}

}  // namespace aims::features
