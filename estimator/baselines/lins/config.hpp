// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>

#include "core/config.hpp"
#include "estimator/baselines/features/feature_matches.hpp"
#include "estimator/baselines/features/feature_solver.hpp"
#include "estimator/baselines/lego_loam/config.hpp"
#include "estimator/baselines/lins/filter.hpp"
#include "estimator/filter/measurement_queue.hpp"
#include "estimator/interface/estimator_config.hpp"

namespace aims::lins {

/// Until when the IMU predicts the motion of a scan.
enum class PredictionEnd {
  kScanStamp,  ///< from stamp to stamp, as the published program: one scan late if a stamp is the
               ///< time of the first firing
  kScanEnd,    ///< from end to end, the time that the motion spans
};

/// Features that a scan needs.
struct MinFeatures {
  int start_edges = 10;    ///< less sharp, of each of the first two scans
  int start_planes = 100;  ///< less flat, likewise
  int edges = 6;           ///< of each later scan
  int planes = 11;
};

void describe(Fields& fields, MinFeatures& config);

/// Start and bookkeeping of the filter.
struct FilterConfig {
  PredictionEnd predict_until = PredictionEnd::kScanStamp;
  double horizontal_force_bias = 0.01;  ///< standard deviation at the start, x and y [m/s^2]
  double vertical_force_bias = 0.02;    ///< likewise, z [m/s^2]
  double gyro_bias = 0.002;             ///< likewise [rad/s]
  double gravity = 0.1;                 ///< likewise, per axis [m/s^2]
  bool turn_gravity =
      false;  ///< gravity follows the LiDAR's rotation; not in the published program
  ProcessNoise noise;
};

void describe(Fields& fields, FilterConfig& config);

/// Registration without IMU, at the start and after a divergence.
struct ScanMatchConfig {
  int min_lines = 5;
  int min_planes = 10;
  features::SolverConfig solver = {.max_iterations = 30,
                                   .association_interval = 1,
                                   .unweighted_iterations = 1,
                                   .remap_threshold = 0.0};
};

void describe(Fields& fields, ScanMatchConfig& config);

/// The published mapping: every scan is offered, and loops are closed within 5 m.
lego_loam::MappingConfig mapping_config();

/// Configuration of LINS; the defaults are those published.
struct Config {
  lego_loam::RangeImageConfig image = {.min_range = 0.0, .ground_rows = 5};
  lego_loam::FeatureConfig features = {.selection = {.curvature = 0.5},
                                       .voxel_order = lego_loam::VoxelOrder::kUpLeftForward};
  MinFeatures min_features;
  features::RingMatchConfig matching = {.truncated_search = true};
  FilterConfig filter;
  UpdateConfig update;
  ScanMatchConfig scan_match;
  lego_loam::MappingConfig mapping = mapping_config();
  QueueConfig queue;
};

void describe(Fields& fields, Config& config);

Requirements requirements_of(const Config& config);

/// Returns from 0.5 m on, as nearer ones are of the robot itself, and no loops: the reference
/// trajectories were made so.
Config corridor();

}  // namespace aims::lins
