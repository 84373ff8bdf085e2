// SPDX-License-Identifier: BSD-3-Clause
#include "estimator/lidar/lidar_config.hpp"

namespace aims {

void describe(Fields& f, LidarUpdateConfig& c) {
  f.number("min_range", c.min_range, {"m", at_least(0), "nearer returns are ignored"});
  f.number("max_range", c.max_range, {"m", positive(), "farther returns are ignored"});
  f.number("selection_voxel", c.selection_voxel,
           {"m", in_range(0.01, 10.0), "one return per voxel of the raw scan is matched"});
  f.integer("max_points", c.max_points, {"-", at_least(1), "returns matched per scan at most"});
  f.number("point_sigma", c.point_sigma,
           {"m", positive(), "error of a point-to-plane residual, R_lidar",
            "tuned on simulated corridors, with doors and smooth"});
  f.number("residual_gate", c.residual_gate,
           {"m", positive(), "larger point-to-plane residuals are rejected"});
  f.integer("max_iterations", c.max_iterations,
            {"-", in_range(1, 50), "iterations of the trial update at most"});
  f.number("convergence_rotation", c.convergence_rotation,
           {"rad", positive(), "smaller steps end the iteration"});
  f.number("convergence_position", c.convergence_position,
           {"m", positive(), "smaller steps end the iteration"});
  f.number("rematch_rotation", c.rematch_rotation,
           {"rad", positive(), "larger rotations search the planes again"});
  f.number("rematch_position", c.rematch_position,
           {"m", positive(), "larger shifts search the planes again"});
  f.integer("min_matches", c.min_matches, {"-", at_least(6), "planes needed for an update"});
}

void describe(Fields& f, RobustKernelConfig& c) {
  f.flag("enabled", c.enabled, {"", any(), "weigh each residual with a Cauchy kernel"});
  f.number("scale", c.scale,
           {"-", positive(), "deviations of a scan's residuals at which a weight is one half"});
  f.number("min_sigma", c.min_sigma, {"m", positive(), "lower bound on that deviation"});
}

void describe(Fields& f, MapConfig& c) {
  f.number("voxel_size", c.voxel_size,
           {"m", in_range(0.05, 10.0), "edge of a voxel of the local map"});
  f.number("point_spacing", c.point_spacing,
           {"m", at_least(0), "returns nearer to a map point merge into it"});
  f.integer("max_points_per_voxel", c.max_points_per_voxel,
            {"-", in_range(5, 32), "map points per voxel at most"});
  f.integer("max_merges", c.max_merges,
            {"-", in_range(1, 255), "returns averaged by a map point at most"});
  f.integer("max_voxels", c.max_voxels,
            {"-", at_least(100), "bound on voxels; the farthest are dropped"});
  f.number("insertion_voxel", c.insertion_voxel,
           {"m", in_range(0.01, 10.0), "one return per voxel of the raw scan is mapped"});
  f.integer("max_insertions", c.max_insertions,
            {"-", at_least(1), "returns mapped per scan at most"});
  f.number("neighbor_gate", c.neighbor_gate,
           {"m", positive(), "largest distance of the five neighbours (at most one voxel)"});
  f.number("plane_thickness", c.plane_thickness,
           {"m", positive(), "largest distance of the five neighbours from their plane"});
  f.number("plane_min_spread", c.plane_min_spread,
           {"m", at_least(0),
            "smallest second principal deviation of the neighbours; docs/decisions.md"});
  f.number("plane_min_ratio", c.plane_min_ratio,
           {"-", at_least(1),
            "smallest ratio of second to smallest principal variance; docs/decisions.md"});
  f.number("map_sigma", c.map_sigma,
           {"m", positive(), "smallest error of a map point across its plane"});
}

void describe(Fields& f, MapCovarianceConfig& c) {
  f.flag("enabled", c.enabled,
         {"", any(), "add the covariance of the map to the stated covariance of the position"});
}

void describe(Fields& f, ForgettingConfig& c) {
  f.flag("enabled", c.enabled, {"", any(), "drop parts of the map that are no longer seen"});
  f.integer("after", c.after,
            {"-", at_least(1), "voxels unseen for this many scans are dropped"});
}

}  // namespace aims
