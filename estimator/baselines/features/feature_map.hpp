// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <vector>

#include "core/config.hpp"
#include "core/lie.hpp"
#include "core/time.hpp"
#include "estimator/baselines/features/feature_matches.hpp"
#include "estimator/baselines/features/feature_selection.hpp"

namespace aims::features {

/// Map points in cubes. The points of a cube are averaged in voxels whenever some are added: an
/// average weighs as much as a new point, so that the map follows the newest scans.
class CubeMap {
 public:
  /// Edges of cubes and voxels [m].
  CubeMap(double cube_size, double voxel_size) : cube_size_(cube_size), voxel_size_(voxel_size) {}

  /// Adds points in map axes.
  void insert(const FeatureCloud& points);

  /// The points of the cubes around `position`: two on each side, one below and above.
  std::vector<Eigen::Vector3f> around(const Eigen::Vector3d& position) const;

  /// All points.
  std::vector<Eigen::Vector3f> points() const;

 private:
  using CubeIndex = std::array<std::int64_t, 3>;
  CubeIndex cube_of(const Eigen::Vector3d& position) const;

  double cube_size_;
  double voxel_size_;
  std::map<CubeIndex, FeatureCloud> cubes_;
};

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

/// Which lines and planes of the map a feature is matched with (LOAM, section VI).
struct MapMatchConfig {
  double max_squared_distance = 1.0;  ///< of the fifth neighbour [m^2]
  double line_ratio = 3.0;            ///< least ratio of the two largest eigenvalues of a line
  double plane_tolerance = 0.2;       ///< largest distance of a neighbour from the plane [m]
  int min_map_edges = 10;             ///< the map needs more points than these
  int min_map_planes = 100;
};

void describe(Fields& fields, MapMatchConfig& config);

/// Neighbours that a line or a plane is fitted to.
inline constexpr int kFitNeighbors = 5;
using FitPoints = std::array<Eigen::Vector3d, kFitNeighbors>;

/// The line through the mean of the points along their largest eigenvector; empty when the largest
/// eigenvalue of their covariance is not more than `ratio` times the second.
std::optional<LineMatch> fit_line(const FitPoints& points, double ratio);

/// The plane n . x = -1 in least squares, with unit normal; empty when a point is farther from it
/// than `tolerance` [m]. A plane through the origin has no such form.
std::optional<PlaneMatch> fit_plane_by_intercepts(const FitPoints& points, double tolerance);

/// The part of a map that a scan is matched with.
class MapReference {
 public:
  void build(std::vector<Eigen::Vector3f> edges, std::vector<Eigen::Vector3f> planes);

  /// Whether the map has enough points.
  bool sufficient(const MapMatchConfig& config) const;

  /// Lines for `edges` and planes for `planes`, scan axes, at the pose T_map_scan.
  FeatureMatches match(const FeatureCloud& edges, const FeatureCloud& planes, const Pose& pose,
                       const MapMatchConfig& config) const;

 private:
  PointIndex edges_;
  PointIndex planes_;
};

}  // namespace aims::features
