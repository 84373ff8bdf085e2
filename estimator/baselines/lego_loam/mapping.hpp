// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <vector>

#include "core/time.hpp"
#include "estimator/baselines/lego_loam/config.hpp"
#include "estimator/baselines/pose_graph/loop_closure.hpp"

namespace aims::lego_loam {

/// Registration of scans to the map of keyframes around them. With loops, it is the map of the last
/// keyframes, and a loop moves them all.
class Mapping {
 public:
  explicit Mapping(const MappingConfig& config)
      : config_(config), keyframes_(config.graph, config.loop) {}

  /// Registers a scan of features at the scan's end, LiDAR axes, whose odometry is `T_odom_lidar`,
  /// and keeps it as a keyframe where the LiDAR has moved; empty when it is not this scan's turn.
  std::optional<features::SolverResult> update(Time stamp, const Pose& T_odom_lidar,
                                               const SegmentedFeatures& scan);

  /// The pose in the map of an odometry pose, with the last correction of the odometry.
  Pose to_map(const Pose& T_odom_lidar) const { return T_map_odom_ * T_odom_lidar; }

  const features::KeyframeMap& map() const { return keyframes_.map(); }

  /// Loops closed so far.
  int loops() const { return keyframes_.loops(); }

 private:
  bool is_due(Time stamp);
  std::vector<int> submap_keyframes() const;
  void build_submap();
  void add_keyframe(features::Keyframe keyframe, const Pose& T_odom_lidar);

  MappingConfig config_;
  pose_graph::KeyframeGraph keyframes_;
  features::MapReference reference_;
  Pose T_map_odom_;
  Eigen::Vector3d last_position_ = Eigen::Vector3d::Zero();  ///< of the last registered scan [m]
  int offered_ = 0;
  std::optional<double> last_seconds_;  ///< stamp of the last registered scan [s]
};

}  // namespace aims::lego_loam
