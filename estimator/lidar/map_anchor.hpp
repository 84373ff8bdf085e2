// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <span>

namespace aims {

/// One plane that a scan was held against, and how well its place in the map is known.
struct AnchoredPlane {
  Eigen::Vector3d normal;  ///< odometry axes, unit
  Eigen::Matrix3d anchor;  ///< covariance of the robot's position when that part of the map was
                           ///< made [m^2]
};

/// How uncertain the map is that the position rests on. A scan tells where the robot is in the map,
/// and the filter's covariance is about that; where the robot is with respect to its start is
/// known as well as the map is, which carries the error that the robot had when it made it.
/// Along each axis of the planes' normals the new value is the old one but for the share that the
/// scan decided, 1 - posterior / prior, which comes from the planes: their anchors' mean, weighted
/// by what each plane tells along that axis. Covariances 3x3 in odometry axes [m^2].
Eigen::Matrix3d anchor_after_scan(const Eigen::Matrix3d& anchor, const Eigen::Matrix3d& prior,
                                  const Eigen::Matrix3d& posterior,
                                  std::span<const AnchoredPlane> planes);

}  // namespace aims
