// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "core/config.hpp"

namespace aims {

/// Point selection, matching and the iterated update (sim has a LidarConfig of its own).
struct LidarUpdateConfig {
  double min_range = 0.3;         ///< [m]
  double max_range = 120.0;       ///< [m]
  bool leave_out_mixed = true;    ///< returns at steps in range, see MixedPixelFilter
  double selection_voxel = 0.25;  ///< one point is kept per voxel of the raw scan [m]
  int max_points = 4000;          ///< per update
  /// Residuals that share one error: R_lidar is the variance of a scan's residuals times this. A
  /// plane is fitted to five map points, each of which serves as many other returns, and the next
  /// scans meet the same planes.
  double correlated_points = 20.0;
  bool enabled = true;     ///< fuse scans
  int max_iterations = 4;  ///< of the trial update
};

void describe(Fields& fields, LidarUpdateConfig& config);

/// Robust weight of each residual: a Cauchy kernel.
struct RobustKernelConfig {
  bool enabled = false;
};

void describe(Fields& fields, RobustKernelConfig& config);

/// Local map and its planes.
struct MapConfig {
  double voxel_size = 0.5;       ///< hashed voxel, and the largest distance of neighbours [m]
  double point_spacing = 0.15;   ///< returns closer than this to a map point merge into it [m]
  int max_voxels = 100000;       ///< beyond it the farthest are dropped
  double insertion_voxel = 0.1;  ///< one point is inserted per voxel of the raw scan [m]
};

void describe(Fields& fields, MapConfig& config);

/// Covariance of the map, added to the stated covariance of the position.
struct MapCovarianceConfig {
  bool enabled = false;
};

void describe(Fields& fields, MapCovarianceConfig& config);

}  // namespace aims
