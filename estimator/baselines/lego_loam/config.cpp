// SPDX-License-Identifier: BSD-3-Clause
#include "estimator/baselines/lego_loam/config.hpp"

namespace aims::lego_loam {

void describe(Fields& f, OdometryConfig& c) {
  f.integer("min_edges", c.min_edges,
            {"-", in_range(0, 1000000), "less sharp features that the last scan needs"});
  f.integer("min_planes", c.min_planes,
            {"-", in_range(0, 1000000), "less flat features that the last scan needs"});
  f.group("matching", c.matching);
  f.group("solver", c.solver);
}

pose_graph::PoseGraphConfig graph_config() {
  pose_graph::PoseGraphConfig config;
  config.position_variance = 1e-8;
  config.height_variance = 1e-6;
  config.relinearize_threshold = 0.01;
  config.firm_start = true;
  return config;
}

pose_graph::LoopConfig loop_config() {
  pose_graph::LoopConfig config;
  config.enabled = false;
  config.radius = 7.0;
  config.average_newer = false;
  config.min_newer_points = 0;
  config.min_older_points = 0;
  config.max_match_distance = 100.0;
  return config;
}

void describe(Fields& f, MappingConfig& c) {
  f.integer("every_nth", c.every_nth,
            {"-", in_range(1, 100), "one scan in this many is offered to the map"});
  f.number("min_interval", c.min_interval,
           {"s", in_range(0.0, 100.0), "between two scans that are registered to the map"});
  f.number("edge_voxel", c.edge_voxel,
           {"m", in_range(0.01, 10.0), "edge points are averaged in such voxels"});
  f.number("plane_voxel", c.plane_voxel,
           {"m", in_range(0.01, 10.0), "plane points are averaged in such voxels"});
  f.number("outlier_voxel", c.outlier_voxel,
           {"m", in_range(0.01, 10.0), "outliers are averaged in such voxels"});
  f.number("keyframe_distance", c.keyframe_distance,
           {"m", up_to(1e4), "a keyframe is kept after this distance"});
  f.number("submap_radius", c.submap_radius,
           {"m", positive_up_to(1e4), "keyframes nearer than this make the map"});
  f.number("keyframe_voxel", c.keyframe_voxel,
           {"m", in_range(0.01, 1e3), "one keyframe is used per voxel of their positions"});
  f.integer("submap_keyframes", c.submap_keyframes,
            {"-", in_range(1, 100000), "the last ones make the map instead when loops are closed",
             "surroundingKeyframeSearchNum"});
  f.group("matching", c.matching);
  f.group("solver", c.solver);
  f.group("graph", c.graph);
  f.group("loop", c.loop);
  f.idle_if(!c.loop.enabled, "loop.enabled is false", {"graph", "submap_keyframes"});
  f.idle_if(c.loop.enabled, "loop.enabled is true", {"submap_radius", "keyframe_voxel"});
}

void describe(Fields& f, Config& c) {
  f.group("image", c.image);
  f.group("features", c.features);
  f.group("odometry", c.odometry);
  f.group("mapping", c.mapping);
  f.group("queue", c.queue);
}

Requirements requirements_of(const Config& config) {
  return {.lidar = true,
          .rings = true,
          .point_times = config.features.point_times == PointTimes::kMeasured,
          .range_image = {config.image.rows, config.image.row_angle_deg}};
}

Config corridor() {
  Config config;
  config.image.min_range = 0.5;
  return config;
}

}  // namespace aims::lego_loam
