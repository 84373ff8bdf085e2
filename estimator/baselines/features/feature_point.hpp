// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <vector>

#include "core/measurements.hpp"

namespace aims::features {

/// A return that a feature-based method uses, LiDAR axes.
struct FeaturePoint {
  Eigen::Vector3f position = Eigen::Vector3f::Zero();  ///< [m]
  float fraction = 0.0F;                               ///< firing time within the scan, 0 to 1
  int ring = 0;                                        ///< 0 = lowest elevation
};

using FeatureCloud = std::vector<FeaturePoint>;

/// More rings than any LiDAR has: returns of higher rings are ignored.
inline constexpr int kMaxRings = 256;

/// The finite returns of a scan between the two ranges [m], one cloud per ring, in firing order.
std::vector<FeatureCloud> ring_clouds(const LidarScan& scan, double min_range, double max_range);

/// The centroid of the points of each voxel of edge `size` [m], in order of its first point; the
/// ring is that of the first point.
FeatureCloud voxel_centroids(const FeatureCloud& cloud, double size);

}  // namespace aims::features
