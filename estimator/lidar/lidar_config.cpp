// SPDX-License-Identifier: BSD-3-Clause
#include "estimator/lidar/lidar_config.hpp"

namespace aims {

void describe(Fields& f, LidarUpdateConfig& c) {
  f.number("min_range", c.min_range, {"m", up_to(1e4), "nearer returns are ignored"});
  f.number("max_range", c.max_range, {"m", positive_up_to(1e4), "farther returns are ignored"});
  f.flag("leave_out_mixed", c.leave_out_mixed,
         {"", any(), "leave out returns that lie between two surfaces"});
  f.number("selection_voxel", c.selection_voxel,
           {"m", in_range(0.01, 10.0), "one return per voxel of the raw scan is matched"});
  f.integer("max_points", c.max_points,
            {"-", in_range(1, 10000000), "returns matched per scan at most"});
  f.number("correlated_points", c.correlated_points,
           {"-", in_range(1.0, 1e6),
            "residuals that share one error; multiplies the variance of the residuals in R_lidar",
            "docs/decisions.md"});
  f.number("residual_gate", c.residual_gate,
           {"m", positive_up_to(1e4), "larger point-to-plane residuals are rejected"});
  f.integer("max_iterations", c.max_iterations,
            {"-", in_range(1, 50), "iterations of the trial update at most"});
  f.number("convergence_rotation", c.convergence_rotation,
           {"rad", positive_up_to(100.0), "smaller steps end the iteration"});
  f.number("convergence_position", c.convergence_position,
           {"m", positive_up_to(1e4), "smaller steps end the iteration"});
  f.number("rematch_rotation", c.rematch_rotation,
           {"rad", positive_up_to(100.0), "larger rotations search the planes again"});
  f.number("rematch_position", c.rematch_position,
           {"m", positive_up_to(1e4), "larger shifts search the planes again"});
  f.integer("min_matches", c.min_matches,
            {"-", in_range(6, 1000000), "planes needed for an update"});
}

void describe(Fields& f, RobustKernelConfig& c) {
  f.flag("enabled", c.enabled, {"", any(), "weigh each residual with a Cauchy kernel"});
  f.number(
      "scale", c.scale,
      {"-", positive_up_to(1e6), "deviations of a scan's residuals at which a weight is one half"});
}

void describe(Fields& f, MapConfig& c) {
  f.number("voxel_size", c.voxel_size,
           {"m", in_range(0.05, 10.0), "edge of a voxel of the local map"});
  f.number("point_spacing", c.point_spacing,
           {"m", up_to(1e4), "returns nearer to a map point merge into it"});
  f.integer("max_points_per_voxel", c.max_points_per_voxel,
            {"-", in_range(5, 32), "map points per voxel at most"});
  f.integer("max_merges", c.max_merges,
            {"-", in_range(1, 255), "returns averaged by a map point at most"});
  f.integer("max_voxels", c.max_voxels,
            {"-", in_range(100, 10000000), "bound on voxels; the farthest are dropped"});
  f.number("insertion_voxel", c.insertion_voxel,
           {"m", in_range(0.01, 10.0), "one return per voxel of the raw scan is mapped"});
  f.integer("max_insertions", c.max_insertions,
            {"-", in_range(1, 10000000), "returns mapped per scan at most"});
  f.number(
      "neighbor_gate", c.neighbor_gate,
      {"m", positive_up_to(1e4), "largest distance of the five neighbours (at most one voxel)"});
  f.number(
      "plane_thickness", c.plane_thickness,
      {"-", positive_up_to(1e4),
       "largest distance of the five neighbours from their plane, in deviations of a residual"});
  f.number("plane_min_spread", c.plane_min_spread,
           {"m", up_to(1e4),
            "smallest second principal deviation of the neighbours; docs/decisions.md"});
  f.number("plane_min_ratio", c.plane_min_ratio,
           {"-", in_range(1.0, 1e9),
            "smallest ratio of second to smallest principal variance; docs/decisions.md"});
}

void describe(Fields& f, MapCovarianceConfig& c) {
  f.flag("enabled", c.enabled,
         {"", any(), "add the covariance of the map to the stated covariance of the position"});
}

void describe(Fields& f, ForgettingConfig& c) {
  f.flag("enabled", c.enabled, {"", any(), "drop parts of the map that are no longer seen"});
  f.integer("after", c.after,
            {"-", in_range(1, 1e6), "voxels unseen for this many scans are dropped"});
}

}  // namespace aims
