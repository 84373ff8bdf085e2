// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <vector>

#include "core/config.hpp"
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

/// How many features of each kind a ring yields (Zhang and Singh, LOAM, RSS 2014, section V-A).
struct SelectionConfig {
  int half_window = 5;           ///< ring neighbours on each side that the curvature sums
  int sectors = 6;               ///< of equal numbers of returns, per ring
  int max_sharp = 2;             ///< sharp edges per sector
  int max_less_sharp = 20;       ///< edges per sector, the sharp ones among them
  int max_flat = 4;              ///< flat points per sector
  double curvature = 0.1;        ///< edges have more, flat points less [m^2]
  double less_flat_voxel = 0.2;  ///< less flat points are averaged in voxels of it, per ring [m]
};

void describe(Fields& fields, SelectionConfig& config);

/// Features of a scan, each cloud in order of rings.
struct RingFeatures {
  int points = 0;  ///< returns in range
  FeatureCloud sharp;
  FeatureCloud less_sharp;  ///< the sharp ones among them
  FeatureCloud flat;
  FeatureCloud less_flat;  ///< voxel centroids of all that is no edge
};

/// The points of a ring, in order of azimuth, with what decides on them; one entry per point.
struct RingCandidates {
  FeatureCloud points;
  std::vector<float> curvature;   ///< [m^2]
  std::vector<bool> unavailable;  ///< neither edge nor flat
  std::vector<bool> joined;       ///< to the next point: a choice excludes neighbours up to a gap
  std::vector<bool> may_be_edge;
  std::vector<bool> may_be_flat;
};

/// Adds the features of one ring: in each sector the points of most curvature as edges, those of
/// least curvature as flat, and the rest as less flat.
void select_features(const RingCandidates& ring, const SelectionConfig& config,
                     RingFeatures& features);

}  // namespace aims::features
