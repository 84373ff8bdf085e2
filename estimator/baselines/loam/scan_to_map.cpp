// SPDX-License-Identifier: BSD-3-Clause
#include "estimator/baselines/loam/scan_to_map.hpp"

namespace aims::loam {
namespace {

features::FeatureCloud transformed(features::FeatureCloud cloud, const Pose& pose) {
  for (features::FeaturePoint& point : cloud) {
    point.position = (pose * point.position.cast<double>()).cast<float>();
  }
  return cloud;
}

}  // namespace

ScanToMap::ScanToMap(const ScanToMapConfig& config)
    : config_(config),
      edges_(config.cube_size, config.edge_voxel),
      planes_(config.cube_size, config.plane_voxel) {}

features::SolverResult ScanToMap::update(const Pose& T_odom_lidar,
                                         const features::RingFeatures& scan) {
  const features::FeatureCloud edges =
      features::voxel_centroids(scan.less_sharp, config_.edge_voxel);
  const features::FeatureCloud planes =
      features::voxel_centroids(scan.less_flat, config_.plane_voxel);
  features::SolverResult result;
  result.pose = to_map(T_odom_lidar);
  reference_.build(edges_.around(result.pose.translation), planes_.around(result.pose.translation));
  if (reference_.sufficient(config_.matching)) {
    const auto associate = [&](const Pose& T_map_lidar) {
      return reference_.match(edges, planes, T_map_lidar, config_.matching);
    };
    result = features::solve_pose(result.pose, associate, config_.solver);
    T_map_odom_ = result.pose * T_odom_lidar.inverse();
    T_map_odom_.rotation.normalize();
  }
  edges_.insert(transformed(edges, result.pose));
  planes_.insert(transformed(planes, result.pose));
  return result;
}

std::vector<Eigen::Vector3f> ScanToMap::points() const {
  std::vector<Eigen::Vector3f> points = edges_.points();
  const std::vector<Eigen::Vector3f> planes = planes_.points();
  points.insert(points.end(), planes.begin(), planes.end());
  return points;
}

}  // namespace aims::loam
