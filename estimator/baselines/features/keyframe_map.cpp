// SPDX-License-Identifier: BSD-3-Clause
#include "estimator/baselines/features/keyframe_map.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numeric>
#include <utility>

namespace aims::features {
namespace {

using Voxel = std::array<long long, 3>;

Voxel voxel_at(const Eigen::Vector3d& position, double size) {
  Voxel voxel{};
  for (int axis = 0; axis < 3; ++axis) {
    voxel[axis] = std::llround(std::floor(position[axis] / size));
  }
  return voxel;
}

void append(const FeatureCloud& cloud, const Pose& pose, FeatureCloud& points) {
  for (FeaturePoint point : cloud) {
    point.position = (pose * point.position.cast<double>()).cast<float>();
    points.push_back(point);
  }
}

}  // namespace

std::vector<int> KeyframeMap::near(const Eigen::Vector3d& position, double radius,
                                   double voxel) const {
  std::map<Voxel, std::pair<long long, int>> voxels;  // sum of indices, count
  for (int i = 0; i < size(); ++i) {
    const Eigen::Vector3d& p = keyframes_[i].T_map_lidar.translation;
    if ((p - position).norm() > radius) continue;
    auto& [sum, count] = voxels[voxel_at(p, voxel)];
    sum += i;
    ++count;
  }
  std::vector<int> indices;
  for (const auto& [index, mean] : voxels) {
    indices.push_back(static_cast<int>(mean.first / mean.second));
  }
  return indices;
}

int KeyframeMap::nearest(const Eigen::Vector3d& position) const {
  const auto distance = [&](const Keyframe& keyframe) {
    return (keyframe.T_map_lidar.translation - position).squaredNorm();
  };
  const auto found = std::min_element(
      keyframes_.begin(), keyframes_.end(),
      [&](const Keyframe& a, const Keyframe& b) { return distance(a) < distance(b); });
  return static_cast<int>(found - keyframes_.begin());
}

std::vector<int> KeyframeMap::near_means(const Eigen::Vector3d& position, double radius,
                                         double voxel) const {
  std::map<Voxel, std::pair<Eigen::Vector3d, int>> voxels;  // sum of positions, count
  for (const Keyframe& keyframe : keyframes_) {
    const Eigen::Vector3d& p = keyframe.T_map_lidar.translation;
    if ((p - position).norm() > radius) continue;
    auto& [sum, count] =
        voxels.try_emplace(voxel_at(p, voxel), Eigen::Vector3d::Zero(), 0).first->second;
    sum += p;
    ++count;
  }
  std::vector<int> indices;
  for (const auto& [index, mean] : voxels) indices.push_back(nearest(mean.first / mean.second));
  return indices;
}

KeyframeMap::Submap KeyframeMap::submap(const std::vector<int>& indices) const {
  Submap submap;
  for (const int i : indices) {
    append(keyframes_[i].edges, keyframes_[i].T_map_lidar, submap.edges);
    append(keyframes_[i].planes, keyframes_[i].T_map_lidar, submap.planes);
    append(keyframes_[i].outliers, keyframes_[i].T_map_lidar, submap.planes);
  }
  return submap;
}

FeatureCloud KeyframeMap::features(const std::vector<int>& indices) const {
  FeatureCloud cloud;
  for (const int i : indices) append(keyframes_[i].edges, keyframes_[i].T_map_lidar, cloud);
  for (const int i : indices) append(keyframes_[i].planes, keyframes_[i].T_map_lidar, cloud);
  return cloud;
}

std::vector<Eigen::Vector3f> KeyframeMap::points() const {
  std::vector<int> all(keyframes_.size());
  std::iota(all.begin(), all.end(), 0);
  const Submap map = submap(all);
  std::vector<Eigen::Vector3f> points;
  for (const FeaturePoint& point : map.edges) points.push_back(point.position);
  for (const FeaturePoint& point : map.planes) points.push_back(point.position);
  return points;
}

}  // namespace aims::features
