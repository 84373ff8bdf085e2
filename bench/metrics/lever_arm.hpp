// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <span>

#include "bench/metrics/association.hpp"

namespace aims {

/// Position of the measured point, e.g. a prism, in the frame of the estimated body.
struct LeverArm {
  Eigen::Vector3d p_body_point = Eigen::Vector3d::Zero();  ///< [m]
  int observed = 0;  ///< directions that the rotation of the body tells; the others are zero
};

/// The lever arm that makes the positions fit best, together with heading and translation between
/// both frames (`level`) or the whole rigid transform: min Σ ‖Q (p̂ + R̂ l) + t − p‖² by Gauss–Newton
/// from l = 0. Of a body that only turns about the vertical, the height of the point is not
/// observable. Zero below four pairs.
LeverArm fit_lever_arm(std::span<const PosePair> pairs, bool level);

/// The trajectory of that point.
Trajectory moved_to_point(Trajectory trajectory, const Eigen::Vector3d& p_body_point);

/// The trajectory of a point that moves in the body, e.g. of a control point that a robot's LiDAR
/// measured where it stood: `points` are its positions in the body by stamp, interpolated between.
/// Each stamp of them within the trajectory becomes a pose of its own. No points: as it is.
Trajectory moved_to_points(const Trajectory& trajectory, const Trajectory& points);

}  // namespace aims
