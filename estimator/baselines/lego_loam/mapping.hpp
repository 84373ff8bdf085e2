// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>

#include "core/time.hpp"
#include "estimator/baselines/features/keyframe_map.hpp"
#include "estimator/baselines/lego_loam/config.hpp"

namespace aims::lego_loam {

/// Registration of scans to the map of keyframes around them.
class Mapping {
 public:
  explicit Mapping(const MappingConfig& config) : config_(config) {}

  /// Registers a scan of features at the scan's end, LiDAR axes, whose odometry is `T_odom_lidar`,
  /// and keeps it as a keyframe where the LiDAR has moved; empty when it is not this scan's turn.
  std::optional<features::SolverResult> update(Time stamp, const Pose& T_odom_lidar,
                                               const SegmentedFeatures& scan);

  /// The pose in the map of an odometry pose, with the last correction of the odometry.
  Pose to_map(const Pose& T_odom_lidar) const { return T_map_odom_ * T_odom_lidar; }

  const features::KeyframeMap& map() const { return map_; }

 private:
  bool is_due(Time stamp);
  void build_submap();

  MappingConfig config_;
  features::KeyframeMap map_;
  features::MapReference reference_;
  Pose T_map_odom_;
  Eigen::Vector3d last_position_ = Eigen::Vector3d::Zero();  ///< of the last registered scan [m]
  int offered_ = 0;
  std::optional<double> last_seconds_;  ///< stamp of the last registered scan [s]
};

}  // namespace aims::lego_loam
