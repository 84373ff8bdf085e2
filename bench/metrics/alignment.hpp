// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <span>
#include <vector>

#include "bench/metrics/association.hpp"

namespace aims {

/// Alignment of the frame of the estimate with the frame of the truth.
enum class AlignmentKind {
  kStartPose,     ///< first pair equal in position and rotation (evo: align_origin)
  kStartHeading,  ///< first pair equal in position and heading; both frames have z up
  kSe3,           ///< least squares over all positions, rotation and translation (Umeyama)
  kYaw,           ///< least squares over all positions, heading and translation (4 DoF)
};

/// The transform from the frame of the estimate to that of the truth, and its kind.
struct Alignment {
  Pose T_truth_estimate;
  AlignmentKind kind = AlignmentKind::kStartPose;
  bool degenerate = false;  ///< rotation unobservable: positions too straight or too few
};

/// Aligns the first pair; identity without pairs.
Alignment align_start(std::span<const PosePair> pairs,
                      AlignmentKind kind = AlignmentKind::kStartPose);

/// Umeyama's least squares without scale. The rotation about a straight line of positions is
/// unobservable: when the second singular value of the cross-covariance is below `straightness`
/// times the first, the result is marked degenerate and is the yaw-only alignment.
Alignment align_se3(std::span<const PosePair> pairs, double straightness);

/// Least squares over heading and translation; degenerate when the positions do not spread.
Alignment align_yaw(std::span<const PosePair> pairs);

/// The pairs with their estimates moved into the truth's frame.
std::vector<PosePair> aligned(std::span<const PosePair> pairs, const Alignment& alignment);

}  // namespace aims
