// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "core/config.hpp"

namespace aims {

/// Point selection, matching and the iterated update (sim has a LidarConfig of its own).
struct LidarUpdateConfig {
  double min_range = 0.3;         ///< [m]
  double max_range = 120.0;       ///< [m]
  bool leave_out_mixed = true;    ///< returns between two surfaces, see RangeSteps
  double selection_voxel = 0.25;  ///< one point is kept per voxel of the raw scan [m]
  int max_points = 4000;          ///< per update
  /// Residuals that share one error: R_lidar is the variance of a scan's residuals times this. A
  /// plane is fitted to five map points, each of which serves as many other returns, and the next
  /// scans meet the same planes.
  double correlated_points = 20.0;
  double residual_gate = 0.2;          ///< larger residuals are rejected [m]
  int max_iterations = 4;              ///< of the trial update
  double convergence_rotation = 1e-4;  ///< [rad]
  double convergence_position = 1e-3;  ///< [m]
  double rematch_rotation = 2e-3;      ///< larger pose changes search the planes again [rad]
  double rematch_position = 1e-2;      ///< larger pose changes search the planes again [m]
  int min_matches = 30;                ///< planes needed for an update
};

void describe(Fields& fields, LidarUpdateConfig& config);

/// Robust weight of each residual: a Cauchy kernel.
struct RobustKernelConfig {
  bool enabled = false;
  double scale = 3.0;  ///< deviations of the residuals at which a weight is one half [-]
};

void describe(Fields& fields, RobustKernelConfig& config);

/// Local map and its planes.
struct MapConfig {
  double voxel_size = 0.5;      ///< hashed voxel; bounds the neighbour search [m]
  double point_spacing = 0.15;  ///< returns closer than this to a map point merge into it [m]
  int max_points_per_voxel = 32;
  int max_merges = 20;             ///< returns averaged by a map point
  int max_voxels = 100000;         ///< beyond it the farthest are dropped
  double insertion_voxel = 0.1;    ///< one point is inserted per voxel of the raw scan [m]
  int max_insertions = 12000;      ///< points per scan
  double neighbor_gate = 0.5;      ///< largest distance of the five neighbours [m]
  double plane_thickness = 3.0;    ///< of the five neighbours, in deviations of a residual [-]
  double plane_min_spread = 0.05;  ///< second principal deviation of the neighbours [m]
  double plane_min_ratio = 10.0;   ///< second over smallest principal variance [-]
};

void describe(Fields& fields, MapConfig& config);

/// Covariance of the map, added to the stated covariance of the position.
struct MapCovarianceConfig {
  bool enabled = false;
};

void describe(Fields& fields, MapCovarianceConfig& config);

/// Forgetting of old parts of the map.
struct ForgettingConfig {
  bool enabled = false;  ///< false: the map is kept for the whole run
  int after = 150;       ///< scans in which a voxel got no point
};

void describe(Fields& fields, ForgettingConfig& config);

}  // namespace aims
