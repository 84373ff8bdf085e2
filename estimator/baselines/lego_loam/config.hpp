// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "core/config.hpp"
#include "estimator/baselines/features/feature_map.hpp"
#include "estimator/baselines/features/feature_matches.hpp"
#include "estimator/baselines/features/feature_solver.hpp"
#include "estimator/baselines/lego_loam/segmented_features.hpp"
#include "estimator/baselines/pose_graph/loop_closure.hpp"
#include "estimator/baselines/pose_graph/pose_graph.hpp"
#include "estimator/filter/measurement_queue.hpp"
#include "estimator/interface/estimator_config.hpp"

namespace aims::lego_loam {

/// Odometry in two steps (LeGO-LOAM, section III-D).
struct OdometryConfig {
  int min_edges = 10;    ///< less sharp features that the last scan needs
  int min_planes = 100;  ///< likewise, less flat
  features::RingMatchConfig matching = {.truncated_search = true};
  features::SolverConfig solver;  ///< of each step
};

void describe(Fields& fields, OdometryConfig& config);

/// Graph of keyframes of the published program.
pose_graph::PoseGraphConfig graph_config();

/// Its loops, which are off by default.
pose_graph::LoopConfig loop_config();

/// Registration of scans to a map of keyframes (LeGO-LOAM, section III-E).
struct MappingConfig {
  int every_nth = 2;               ///< one scan in this many is offered to the map
  double min_interval = 0.3;       ///< between two scans that are registered [s]
  double edge_voxel = 0.2;         ///< [m]
  double plane_voxel = 0.4;        ///< [m]
  double outlier_voxel = 0.4;      ///< [m]
  double keyframe_distance = 0.3;  ///< a keyframe is kept after this distance [m]
  double submap_radius = 50.0;     ///< without loops, keyframes nearer than this make the map [m]
  double keyframe_voxel = 1.0;     ///< one of them is used per voxel of their positions [m]
  int submap_keyframes = 50;       ///< with loops, the last ones make the map
  features::MapMatchConfig matching = {};
  features::SolverConfig solver = features::map_solver_config();
  pose_graph::PoseGraphConfig graph = graph_config();
  pose_graph::LoopConfig loop = loop_config();
};

void describe(Fields& fields, MappingConfig& config);

/// Configuration of LeGO-LOAM without IMU; the defaults are those published.
struct Config {
  RangeImageConfig image;
  FeatureConfig features;
  OdometryConfig odometry;
  MappingConfig mapping;
  QueueConfig queue;
};

void describe(Fields& fields, Config& config);

Requirements requirements_of(const Config& config);

/// Returns from 0.5 m on: the walls of a corridor are nearer than the published 1 m.
Config corridor();

}  // namespace aims::lego_loam
