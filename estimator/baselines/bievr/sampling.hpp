// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "core/lie.hpp"
#include "estimator/baselines/bievr/bump_map.hpp"

namespace aims::bievr {

/// Points of a scan chosen for registration.
struct Sample {
  std::vector<Eigen::Vector3d> points;  ///< first those of voxels of much relief [m, body axes]
  std::size_t fine = 0;                 ///< how many these are
};

/// Of the points in each voxel of edge `voxel` [m], the one nearest to its centre, in order of
/// voxels.
std::vector<Eigen::Vector3d> thinned(const std::vector<Eigen::Vector3d>& points, double voxel);

/// All points in the `count` voxels of the map with the most relief that hold more than one, and
/// one point in each other voxel; all points where there are no more than `count`. `T_world_body`
/// is the predicted pose.
Sample informed_sample(const std::vector<Eigen::Vector3d>& points, const BumpMap& map,
                       const Pose& T_world_body, std::size_t count);

}  // namespace aims::bievr
