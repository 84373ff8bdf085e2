// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <optional>
#include <span>

#include "core/config.hpp"
#include "estimator/baselines/features/feature_matches.hpp"
#include "estimator/baselines/features/feature_point.hpp"
#include "estimator/baselines/features/point_index.hpp"

namespace aims::features {

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
