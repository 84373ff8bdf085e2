// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "core/measurements.hpp"
#include "estimator/baselines/bievr/inertial_window.hpp"

namespace aims::bievr {

/// The returns of a scan that are near enough, in body axes.
struct TimedPoints {
  std::vector<Eigen::Vector3d> points;  ///< each at its own firing [m]
  std::vector<Time> stamps;             ///< of the firings
};

TimedPoints points_in_range(const LidarScan& scan, const Pose& T_body_lidar, const Points& config);

/// The points in body axes at the end of `segments`. `from`: at their begin. Poses between the ends
/// of segments are interpolated; a point outside of the segments keeps the pose of their begin or
/// end.
std::vector<Eigen::Vector3d> deskewed(const TimedPoints& scan, const NavState& from,
                                      const std::vector<InertialSegment>& segments,
                                      const InertialState& x);

}  // namespace aims::bievr
