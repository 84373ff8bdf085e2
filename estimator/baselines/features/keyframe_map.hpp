// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "core/lie.hpp"
#include "core/time.hpp"
#include "estimator/baselines/features/feature_point.hpp"

namespace aims::features {

/// Features of a scan and where it was taken.
struct Keyframe {
  Pose T_map_lidar;
  FeatureCloud edges;   ///< LiDAR axes
  FeatureCloud planes;  ///< likewise
  Time stamp = 0;
  FeatureCloud outliers = {};  ///< planes of the map, too, but no features (LeGO-LOAM); LiDAR axes
};

/// The keyframes of a map, and those that a scan is matched with.
class KeyframeMap {
 public:
  void add(Keyframe keyframe) { keyframes_.push_back(std::move(keyframe)); }
  bool empty() const { return keyframes_.empty(); }
  int size() const { return static_cast<int>(keyframes_.size()); }
  const Keyframe& operator[](int index) const { return keyframes_[index]; }
  const Pose& last_pose() const { return keyframes_.back().T_map_lidar; }
  void set_pose(int index, const Pose& T_map_lidar) { keyframes_[index].T_map_lidar = T_map_lidar; }

  /// Indices of the keyframes within `radius` [m] of a position, thinned as LeGO-LOAM's program
  /// does: a voxel of edge `voxel` [m] yields the keyframe of the mean index in it, whole part.
  /// Where a route returns, that keyframe lies elsewhere.
  std::vector<int> near(const Eigen::Vector3d& position, double radius, double voxel) const;

  /// The same, but a voxel yields the keyframe that is nearest to the mean of the positions in it.
  std::vector<int> near_means(const Eigen::Vector3d& position, double radius, double voxel) const;

  /// Points of these keyframes in map axes.
  struct Submap {
    FeatureCloud edges;
    FeatureCloud planes;
  };
  Submap submap(const std::vector<int>& indices) const;

  /// Edges, then planes of these keyframes in map axes, without outliers.
  FeatureCloud features(const std::vector<int>& indices) const;

  /// Points of all keyframes in map axes.
  std::vector<Eigen::Vector3f> points() const;

 private:
  int nearest(const Eigen::Vector3d& position) const;

  std::vector<Keyframe> keyframes_;
};

}  // namespace aims::features
