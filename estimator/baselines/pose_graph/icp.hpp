// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <vector>

#include "core/lie.hpp"
#include "estimator/baselines/features/point_index.hpp"

namespace aims::pose_graph {

/// What the alignment of two clouds found.
struct IcpResult {
  Pose T_target_source;
  double fitness = 0.0;  ///< mean squared distance of the source's points from the target [m^2]
  int iterations = 0;    ///< 0: too few points in reach
};

/// Aligns a cloud with another by iterated closest points (Besl and McKay 1992), with the rules of
/// the Point Cloud Library for an end: a step below 1 mm and 1.4 mrad, or a mean squared distance
/// that changes by less than 1e-6 m^2 or a part of 1e-5. Points farther than `max_distance` [m] are
/// left out. Both clouds have the same axes.
IcpResult align(const std::vector<Eigen::Vector3f>& source, const features::PointIndex& target,
                double max_distance);

}  // namespace aims::pose_graph
