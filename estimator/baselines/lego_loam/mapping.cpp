// SPDX-License-Identifier: BSD-3-Clause
#include "estimator/baselines/lego_loam/mapping.hpp"

#include <algorithm>
#include <numeric>
#include <utility>

namespace aims::lego_loam {
namespace {

/// As ROS has it. Of scans at 10 Hz, the third one may come less than 0.3 s later by rounding.
double rounded_seconds(Time stamp) {
  return static_cast<double>(stamp / kSecond) + 1e-9 * static_cast<double>(stamp % kSecond);
}

}  // namespace

bool Mapping::is_due(Time stamp) {
  if (offered_++ % config_.every_nth != 0) return false;
  const double seconds = rounded_seconds(stamp);
  if (last_seconds_ && seconds - *last_seconds_ < config_.min_interval) return false;
  last_seconds_ = seconds;
  return true;
}

std::vector<int> Mapping::submap_keyframes() const {
  if (!config_.loop.enabled) {
    return map().near(last_position_, config_.submap_radius, config_.keyframe_voxel);
  }
  std::vector<int> last(std::min(map().size(), config_.submap_keyframes));
  std::iota(last.begin(), last.end(), map().size() - static_cast<int>(last.size()));
  return last;
}

void Mapping::build_submap() {
  const features::KeyframeMap::Submap submap = map().submap(submap_keyframes());
  reference_.build(positions_of(voxel_centroids(submap.edges, config_.edge_voxel)),
                   positions_of(voxel_centroids(submap.planes, config_.plane_voxel)));
}

/// Where loops move the keyframe, the present pose follows.
void Mapping::add_keyframe(features::Keyframe keyframe, const Pose& T_odom_lidar) {
  if (!config_.loop.enabled) {
    keyframes_.add_fixed(std::move(keyframe));
    return;
  }
  keyframes_.add(std::move(keyframe));
  T_map_odom_ = map().last_pose() * T_odom_lidar.inverse();
  T_map_odom_.rotation.normalize();
  last_position_ = map().last_pose().translation;
}

std::optional<features::SolverResult> Mapping::update(Time stamp, const Pose& T_odom_lidar,
                                                      const SegmentedFeatures& scan) {
  if (!is_due(stamp)) return std::nullopt;
  const auto edges = voxel_centroids(scan.features.less_sharp, config_.edge_voxel);
  const auto keyframe_planes = voxel_centroids(scan.features.less_flat, config_.plane_voxel);
  const auto outliers = voxel_centroids(scan.outliers, config_.outlier_voxel);
  auto planes = keyframe_planes;
  planes.insert(planes.end(), outliers.begin(), outliers.end());
  planes = voxel_centroids(planes, config_.plane_voxel);
  features::SolverResult result;
  result.pose = to_map(T_odom_lidar);
  build_submap();
  if (reference_.sufficient(config_.matching)) {
    const auto associate = [&](const Pose& T_map_lidar) {
      return reference_.match(edges, planes, T_map_lidar, config_.matching);
    };
    result = features::solve_pose(result.pose, associate, config_.solver);
    T_map_odom_ = result.pose * T_odom_lidar.inverse();
    T_map_odom_.rotation.normalize();
  }
  last_position_ = result.pose.translation;
  const bool moved = map().empty() || (last_position_ - map().last_pose().translation).norm() >=
                                          config_.keyframe_distance;
  if (moved) add_keyframe({result.pose, edges, keyframe_planes, stamp, outliers}, T_odom_lidar);
  keyframes_.search(stamp, last_position_);
  return result;
}

}  // namespace aims::lego_loam
