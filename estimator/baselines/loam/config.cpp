// SPDX-License-Identifier: BSD-3-Clause
#include "estimator/baselines/loam/config.hpp"

namespace aims::loam {
namespace {

/// Two rounds of matches, each with up to four damped steps.
void use_levenberg_marquardt(features::SolverConfig& solver) {
  solver.method = features::SolverMethod::kLevenbergMarquardt;
  solver.max_iterations = 8;
  solver.association_interval = 4;
}

}  // namespace

void describe(Fields& f, ScanToScanConfig& c) {
  f.flag(
      "deskew", c.deskew,
      {"", any(), "interpolate the motion within the scan; false: a rigid scan", "LOAM, eq. (4)"});
  f.integer("min_edges", c.min_edges,
            {"-", in_range(0, 1000000), "the last scan needs more less sharp features"});
  f.integer("min_planes", c.min_planes,
            {"-", in_range(0, 1000000), "the last scan needs more less flat features"});
  f.group("matching", c.matching);
  f.group("solver", c.solver);
}

void describe(Fields& f, ScanToMapConfig& c) {
  f.integer("interval", c.interval,
            {"-", in_range(1, 100), "one scan in this many is registered to the map"});
  f.number("edge_voxel", c.edge_voxel,
           {"m", in_range(0.01, 10.0), "edge points are averaged in such voxels"});
  f.number("plane_voxel", c.plane_voxel,
           {"m", in_range(0.01, 10.0), "plane points are averaged in such voxels"});
  f.number("cube_size", c.cube_size,
           {"m", in_range(0.5, 1e4), "edge of the cubes of the map; 5 x 5 x 3 are matched"});
  f.group("matching", c.matching);
  f.group("solver", c.solver);
}

void describe(Fields& f, Config& c) {
  f.group("features", c.features);
  f.group("odometry", c.odometry);
  f.group("mapping", c.mapping);
  f.group("queue", c.queue);
}

Requirements requirements_of(const Config& config) {
  return {.lidar = true, .rings = true, .point_times = config.odometry.deskew};
}

Config corridor() {
  Config config;
  config.mapping.edge_voxel = 0.1;
  config.mapping.plane_voxel = 0.2;
  return config;
}

Config a_loam() {
  Config config;
  config.features.reject_unreliable = false;
  config.odometry.deskew = false;
  config.odometry.min_edges = 0;
  config.odometry.min_planes = 0;
  use_levenberg_marquardt(config.odometry.solver);
  config.mapping.interval = 1;
  config.mapping.matching.min_map_planes = 50;
  use_levenberg_marquardt(config.mapping.solver);
  return config;
}

}  // namespace aims::loam
