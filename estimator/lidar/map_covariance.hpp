// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <span>

namespace aims {

/// A matched plane with the uncertainty of its part of the map.
struct MappedPlane {
  Eigen::Vector3d normal;      ///< odometry axes, unit
  Eigen::Matrix3d covariance;  ///< of the robot's position when that part was mapped [m^2]
};

/// Covariance of the map that the position is measured against, after a scan. The filter's
/// covariance is relative to the map; the map itself has the error that the robot had when it built
/// it, and the position in the odometry frame has both. Along each principal axis of the normals
/// the new variance is (1 - k) old + k planes, with the fraction k = 1 - posterior / prior decided
/// by the scan, and the mean variance of the planes weighted by cos^2 of their normals to the axis.
/// Covariances 3x3 in odometry axes [m^2].
Eigen::Matrix3d map_covariance_after_scan(const Eigen::Matrix3d& map_covariance,
                                          const Eigen::Matrix3d& prior,
                                          const Eigen::Matrix3d& posterior,
                                          std::span<const MappedPlane> planes);

}  // namespace aims
