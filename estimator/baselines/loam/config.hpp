// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "core/config.hpp"
#include "estimator/baselines/features/feature_map.hpp"
#include "estimator/baselines/features/feature_matches.hpp"
#include "estimator/baselines/features/feature_solver.hpp"
#include "estimator/baselines/features/ring_features.hpp"
#include "estimator/filter/measurement_queue.hpp"
#include "estimator/interface/estimator_config.hpp"

namespace aims::loam {

/// Odometry from one scan to the next (LOAM, section V).
struct ScanToScanConfig {
  bool deskew = true;    ///< with the motion interpolated within the scan; false: a rigid scan
  int min_edges = 10;    ///< the last scan needs more less sharp features than these
  int min_planes = 100;  ///< likewise, less flat
  features::RingMatchConfig matching;
  features::SolverConfig solver;
};

void describe(Fields& fields, ScanToScanConfig& config);

/// Registration of scans to the map (LOAM, section VI).
struct ScanToMapConfig {
  int interval = 2;          ///< one scan in this many is registered and mapped
  double edge_voxel = 0.2;   ///< of the map and of the scan registered to it [m]
  double plane_voxel = 0.4;  ///< likewise [m]
  double cube_size = 50.0;   ///< edge of the cubes of the map; those around the LiDAR are used [m]
  features::MapMatchConfig matching;
  features::SolverConfig solver = features::map_solver_config();
};

void describe(Fields& fields, ScanToMapConfig& config);

/// Configuration of LOAM without IMU; the defaults are those published.
struct Config {
  features::RingFeatureConfig features;
  ScanToScanConfig odometry;
  ScanToMapConfig mapping;
  QueueConfig queue;
};

void describe(Fields& fields, Config& config);

Requirements requirements_of(const Config& config);

/// Smaller voxels of the map: those published are as large as the recesses of a corridor, and hide
/// what constrains its longitudinal direction.
Config corridor();

/// A-LOAM: Levenberg and Marquardt's method under Huber's loss, every scan taken as rigid and
/// mapped, no unreliable returns rejected, no remapping of degenerate directions.
Config a_loam();

}  // namespace aims::loam
