// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "core/lie.hpp"
#include "estimator/baselines/features/feature_point.hpp"

namespace aims::lego_loam {

/// Features of a scan and where it was taken.
struct Keyframe {
  Pose T_map_lidar;
  features::FeatureCloud edges;   ///< LiDAR axes
  features::FeatureCloud planes;  ///< likewise, outliers among them
};

/// The keyframes of a map, and those that a scan is matched with.
class KeyframeMap {
 public:
  void add(Keyframe keyframe) { keyframes_.push_back(std::move(keyframe)); }
  bool empty() const { return keyframes_.empty(); }
  const Pose& last_pose() const { return keyframes_.back().T_map_lidar; }

  /// Indices of the keyframes within `radius` [m] of a position, thinned as the published program
  /// does: a voxel of edge `voxel` [m] yields the keyframe of the mean index in it, whole part.
  /// Where a route returns, that keyframe lies elsewhere.
  std::vector<int> near(const Eigen::Vector3d& position, double radius, double voxel) const;

  /// Points of these keyframes in map axes.
  struct Submap {
    features::FeatureCloud edges;
    features::FeatureCloud planes;
  };
  Submap submap(const std::vector<int>& indices) const;

  /// Points of all keyframes in map axes.
  std::vector<Eigen::Vector3f> points() const;

 private:
  std::vector<Keyframe> keyframes_;
};

}  // namespace aims::lego_loam
