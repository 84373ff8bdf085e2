// SPDX-License-Identifier: BSD-3-Clause
#include "estimator/baselines/lego_loam/keyframe_map.hpp"

#include <array>
#include <cmath>
#include <map>
#include <numeric>
#include <utility>

namespace aims::lego_loam {
namespace {

void append(const features::FeatureCloud& cloud, const Pose& pose, features::FeatureCloud& points) {
  for (features::FeaturePoint point : cloud) {
    point.position = (pose * point.position.cast<double>()).cast<float>();
    points.push_back(point);
  }
}

}  // namespace

std::vector<int> KeyframeMap::near(const Eigen::Vector3d& position, double radius,
                                   double voxel) const {
  std::map<std::array<long long, 3>, std::pair<long long, int>> voxels;  // sum of indices, count
  for (int i = 0; i < static_cast<int>(keyframes_.size()); ++i) {
    const Eigen::Vector3d& p = keyframes_[i].T_map_lidar.translation;
    if ((p - position).norm() > radius) continue;
    std::array<long long, 3> index{};
    for (int axis = 0; axis < 3; ++axis) index[axis] = std::llround(std::floor(p[axis] / voxel));
    auto& [sum, count] = voxels[index];
    sum += i;
    ++count;
  }
  std::vector<int> indices;
  for (const auto& [index, mean] : voxels) {
    indices.push_back(static_cast<int>(mean.first / mean.second));
  }
  return indices;
}

KeyframeMap::Submap KeyframeMap::submap(const std::vector<int>& indices) const {
  Submap submap;
  for (const int i : indices) {
    append(keyframes_[i].edges, keyframes_[i].T_map_lidar, submap.edges);
    append(keyframes_[i].planes, keyframes_[i].T_map_lidar, submap.planes);
  }
  return submap;
}

std::vector<Eigen::Vector3f> KeyframeMap::points() const {
  std::vector<int> all(keyframes_.size());
  std::iota(all.begin(), all.end(), 0);
  const Submap map = submap(all);
  std::vector<Eigen::Vector3f> points;
  for (const features::FeaturePoint& point : map.edges) points.push_back(point.position);
  for (const features::FeaturePoint& point : map.planes) points.push_back(point.position);
  return points;
}

}  // namespace aims::lego_loam
