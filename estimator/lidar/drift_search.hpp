// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <optional>
#include <span>

#include "core/lie.hpp"
#include "estimator/lidar/plane_model.hpp"
#include "estimator/lidar/voxel_map.hpp"

namespace aims {

/// Points that agree on an offset, at least.
inline constexpr int kMinConsensus = 8;

/// Whether a displacement along `axis` (unit vector, odometry axes) moves points off `plane`.
bool faces_along(const Plane& plane, const Eigen::Vector3d& axis);

/// Where along `axis` (unit vector, odometry axes) a scan lies in the map: the offset of its pose
/// `T_odom_body`, at most `reach` to either side [m], at which the most of `points` (body axes) lie
/// on planes of `map` that face along the axis. Nothing where fewer than kMinConsensus points agree
/// on an offset. Each point counts for the nearest of its planes.
std::optional<double> offset_by_consensus(std::span<const Eigen::Vector3d> points,
                                          const Pose& T_odom_body, const Eigen::Vector3d& axis,
                                          double reach, const VoxelMap& map);

}  // namespace aims
