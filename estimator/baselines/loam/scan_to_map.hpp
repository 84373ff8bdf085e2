// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "estimator/baselines/features/feature_map.hpp"
#include "estimator/baselines/loam/config.hpp"

namespace aims::loam {

/// Registration of the features of a scan to a map of edges and planes, which it extends.
class ScanToMap {
 public:
  explicit ScanToMap(const ScanToMapConfig& config);

  /// Registers and maps the less sharp and less flat features of a scan, LiDAR axes, whose odometry
  /// is `T_odom_lidar`.
  features::SolverResult update(const Pose& T_odom_lidar, const features::RingFeatures& scan);

  /// The pose in the map of an odometry pose, with the last correction of the odometry.
  Pose to_map(const Pose& T_odom_lidar) const { return T_map_odom_ * T_odom_lidar; }

  /// Points of the whole map [m].
  std::vector<Eigen::Vector3f> points() const;

 private:
  ScanToMapConfig config_;
  features::CubeMap edges_;
  features::CubeMap planes_;
  features::MapReference reference_;
  Pose T_map_odom_;
};

}  // namespace aims::loam
