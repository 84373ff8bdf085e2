// SPDX-License-Identifier: BSD-3-Clause
#include "estimator/baselines/lego_loam/mapping.hpp"

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

void Mapping::build_submap() {
  const auto indices = map_.near(last_position_, config_.submap_radius, config_.keyframe_voxel);
  const features::KeyframeMap::Submap submap = map_.submap(indices);
  reference_.build(positions_of(voxel_centroids(submap.edges, config_.edge_voxel)),
                   positions_of(voxel_centroids(submap.planes, config_.plane_voxel)));
}

std::optional<features::SolverResult> Mapping::update(Time stamp, const Pose& T_odom_lidar,
                                                      const SegmentedFeatures& scan) {
  if (!is_due(stamp)) return std::nullopt;
  const auto edges = voxel_centroids(scan.features.less_sharp, config_.edge_voxel);
  auto keyframe_planes = voxel_centroids(scan.features.less_flat, config_.plane_voxel);
  const auto outliers = voxel_centroids(scan.outliers, config_.outlier_voxel);
  keyframe_planes.insert(keyframe_planes.end(), outliers.begin(), outliers.end());
  const auto planes = voxel_centroids(keyframe_planes, config_.plane_voxel);
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
  const bool moved = map_.empty() || (last_position_ - map_.last_pose().translation).norm() >=
                                         config_.keyframe_distance;
  if (moved) map_.add({result.pose, edges, keyframe_planes, stamp});
  return result;
}

}  // namespace aims::lego_loam
