// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "core/measurements.hpp"
#include "estimator/baselines/fast_lio2/config.hpp"
#include "estimator/baselines/fast_lio2/state.hpp"

namespace aims::fast_lio2 {

/// State at the start of the scan or at an IMU sample, with the inertial step that led to it.
struct Knot {
  Time stamp = 0;
  Pose T_world_body;
  Eigen::Vector3d velocity = Eigen::Vector3d::Zero();      ///< v_world_body [m/s]
  Eigen::Vector3d rate = Eigen::Vector3d::Zero();          ///< of the step, unbiased [rad/s]
  Eigen::Vector3d acceleration = Eigen::Vector3d::Zero();  ///< likewise, of the body in the world
};

/// One return of every n that is not too near, as indices into `scan`.
std::vector<int> selected_points(const LidarScan& scan, const Points& config);

/// The time that the state is estimated at: that of the last point used, so a sample of the IMU at
/// the scan's nominal end counts for the next scan; that end when the points cover less than half
/// of the scan.
Time end_of(const LidarScan& scan, std::span<const int> indices);

/// The points in LiDAR axes at the time of `end`. The pose at the firing of a point follows from
/// the last knot before it that has another after it, by the rate and acceleration of that other
/// one. As in the published program, a point that is not later than the first knot stays as it is.
std::vector<Eigen::Vector3f> deskewed(const LidarScan& scan, std::span<const int> indices,
                                      std::span<const Knot> knots, const State& end);

}  // namespace aims::fast_lio2
