// SPDX-License-Identifier: BSD-3-Clause
#include "estimator/lidar/lidar_config.hpp"

namespace aims {

void describe(Fields& f, LidarUpdateConfig& c) {
  f.flag("enabled", c.enabled, {"", any(), "fuse scans of the LiDAR"});
  f.number("min_range", c.min_range,
           {"m", up_to(1e4), "nearer returns are ignored", "LiDAR datasheets: 0.1 to 0.5 m"});
  f.number(
      "max_range", c.max_range,
      {"m", positive_up_to(1e4), "farther returns are ignored", "LiDAR datasheets: 100 to 120 m"});
  f.flag("leave_out_mixed", c.leave_out_mixed,
         {"", any(), "leave out returns between two surfaces, and the last of the nearer one"});
  f.number("selection_voxel", c.selection_voxel,
           {"m", in_range(0.01, 10.0), "one return per voxel of the raw scan is matched",
            "docs/decisions.md#one-return-per-25-cm-is-matched"});
  f.integer("max_points", c.max_points,
            {"-", in_range(1, 10000000), "returns matched per scan at most", "bound on time"});
  f.number("correlated_points", c.correlated_points,
           {"-", in_range(1.0, 1e6),
            "residuals that share one error; multiplies the variance of the residuals in R_lidar",
            "docs/decisions.md#r_lidar-from-the-residuals"});
  f.integer("max_iterations", c.max_iterations,
            {"-", in_range(1, 50),
             "iterations of the trial update at most, more while they are large", "bound on time"});
}

void describe(Fields& f, RobustKernelConfig& c) {
  f.flag("enabled", c.enabled, {"", any(), "weigh each residual with a Cauchy kernel"});
}

void describe(Fields& f, MapConfig& c) {
  f.number("voxel_size", c.voxel_size,
           {"m", in_range(0.05, 10.0),
            "edge of a voxel of the local map, and the largest distance of neighbours",
            "rings 2 deg apart meet a wall 14 m away 0.5 m apart"});
  f.number("point_spacing", c.point_spacing,
           {"m", up_to(1e4), "returns nearer to a map point merge into it",
            "docs/decisions.md#edges-in-balance"});
  f.integer("max_voxels", c.max_voxels,
            {"-", in_range(100, 10000000), "bound on voxels; the farthest are dropped",
             "bound on memory: 0.1 GB"});
  f.number("insertion_voxel", c.insertion_voxel,
           {"m", in_range(0.01, 10.0), "one return per voxel of the raw scan is mapped",
            "chosen: finer than the map, which merges returns"});
}

void describe(Fields& f, MapCovarianceConfig& c) {
  f.flag("enabled", c.enabled,
         {"", any(), "add the covariance of the map to the stated covariance of the position"});
}

}  // namespace aims
