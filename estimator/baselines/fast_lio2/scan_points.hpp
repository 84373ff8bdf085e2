// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "core/measurements.hpp"
#include "estimator/baselines/fast_lio2/config.hpp"
#include "estimator/baselines/fast_lio2/state.hpp"

namespace aims::fast_lio2 {

/// State at an IMU sample, or at the last scan's end, with the inertial step that follows.
struct Knot {
  Time stamp = 0;
  Pose T_world_body;
  Eigen::Vector3d velocity = Eigen::Vector3d::Zero();  ///< v_world_body [m/s]
  Eigen::Vector3d rate = Eigen::Vector3d::Zero();      ///< until the next knot, unbiased [rad/s]
  Eigen::Vector3d acceleration = Eigen::Vector3d::Zero();  ///< likewise, of the body in the world
};

/// One return of every n that is not blind, as indices into `scan`.
std::vector<int> selected_points(const LidarScan& scan, const Points& config);

/// The points in LiDAR axes at the time of `end`: each is moved from the pose at its firing, which
/// the last knot before it gives by constant rate and acceleration. `knots` are in order of time
/// and not empty.
std::vector<Eigen::Vector3f> deskewed(const LidarScan& scan, std::span<const int> indices,
                                      std::span<const Knot> knots, const State& end);

/// The centroid of the points in each voxel of edge `voxel` [m], in order of z, y, x of the voxels.
std::vector<Eigen::Vector3f> voxel_centroids(std::span<const Eigen::Vector3f> points, double voxel);

}  // namespace aims::fast_lio2
