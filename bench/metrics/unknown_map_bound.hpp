// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "bench/metrics/posterior_bound.hpp"

namespace aims {

/// A part of a map that is known without a robot's help.
inline constexpr int kKnownPart = -1;

/// What one scan measures of one part of the map.
struct PartInformation {
  int part = kKnownPart;  ///< index of the part
  /// Of the body's pose relative to the part, as `ScanInformation::information`.
  Eigen::Matrix<double, 6, 6> information = Eigen::Matrix<double, 6, 6>::Zero();
};

/// A scan's information by the part of the map that it comes from.
struct ScanView {
  Time stamp = 0;  ///< true end of the scan
  std::vector<PartInformation> parts;
};

/// Posterior Cramer-Rao bound of a robot that builds its map as it goes: IMU, legs and LiDAR
/// linearised at the true motion, as `posterior_bounds`, but each part of the map has an unknown
/// pose of its own without prior knowledge. A scan measures the body's pose relative to the parts
/// that it sees; a part seen once gives nothing, and one seen before transfers the pose error at
/// which it was mapped. Within a part the shape counts as known, so that it remains a lower bound;
/// smaller parts make it tighter. `centres` are the parts' positions in the world, `views` are in
/// order of time. One entry per view inside the motion's span.
std::vector<PosteriorBound> unknown_map_bounds(std::span<const TrueMotion> motion,
                                               std::span<const ScanView> views,
                                               std::span<const Eigen::Vector3d> centres,
                                               const BoundParameters& parameters);

}  // namespace aims
