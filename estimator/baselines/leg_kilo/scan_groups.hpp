// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <vector>

#include "estimator/baselines/leg_kilo/config.hpp"

namespace aims::leg_kilo {

/// Position [m] in LiDAR axes and firing time after the first point of the scan [s].
using TimedPoint = Eigen::Vector4f;

/// Points of a scan that are taken as fired at one instant.
struct PointGroup {
  Time stamp = 0;
  std::vector<Eigen::Vector3d> points;  ///< LiDAR axes at that instant [m]
};

/// The returns used, with their rounded firing times.
std::vector<TimedPoint> timed_points(const LidarScan& scan, const Points& config);

/// The scan in the order in which the filter takes it: centroids of voxels, at the mean of the
/// times of their points; those of equal time are one group.
std::vector<PointGroup> point_groups(const LidarScan& scan, const Points& config);

/// The firing of the first return and of the last one.
Time first_firing(const LidarScan& scan);
Time last_firing(const LidarScan& scan);

}  // namespace aims::leg_kilo
