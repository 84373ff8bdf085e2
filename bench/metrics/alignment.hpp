// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <span>
#include <vector>

#include "bench/metrics/association.hpp"

namespace aims {

/// Alignment of the frame of the estimate with the frame of the truth.
enum class AlignmentKind {
  kStartPose,     ///< start equal in position and rotation
  kStartHeading,  ///< first pair equal in position and heading; both frames have z up
  kSe3,           ///< least squares over all positions, rotation and translation (Umeyama)
  kSim3,          ///< the same with a scale
  kYaw,           ///< least squares over all positions, heading and translation (4 DoF)
  kStartYaw,      ///< first pair equal in position, heading of kYaw: for a truth without attitude
  kStartSe3,      ///< the same with the rotation of kSe3
};

/// What the positions tell of the rotation between both frames.
enum class PositionSpread {
  kFull,   ///< all of it
  kLine,   ///< two angles: the rotation about the line of motion stays unknown
  kPoint,  ///< nothing
};

/// The transform from the frame of the estimate to that of the truth, and its kind.
struct Alignment {
  Pose T_truth_estimate;
  AlignmentKind kind = AlignmentKind::kStartPose;
  PositionSpread spread = PositionSpread::kFull;  ///< of least squares; kPoint without pairs
  double scale = 1.0;                             ///< of the positions of the estimate [-]
};

/// Aligns the start; identity without pairs. By heading, the first pair becomes equal. By pose, the
/// mean over the second half of `standing_start` does, so that an estimator that levels itself
/// while standing is not held to its first attitude; a truth that walks off at once has the first
/// pair only, as evo's align_origin. The kinds kStartYaw and kStartSe3 need no attitude of the
/// truth.
Alignment align_start(std::span<const PosePair> pairs,
                      AlignmentKind kind = AlignmentKind::kStartPose);

/// The first pairs, over at most 10 s, during which the truth stays within 5 cm and 0.05 rad of the
/// first; that pair alone when they last less than 0.5 s.
std::span<const PosePair> standing_start(std::span<const PosePair> pairs);

/// Umeyama's least squares without scale, and as in evo: wherever two singular values of the
/// cross-covariance exceed the machine epsilon [m^2]. Of positions on a line, where evo refuses,
/// the two observable angles are of least squares too, and the rotation about the line is that of
/// the first pair; of positions on a point, all of it is.
Alignment align_se3(std::span<const PosePair> pairs);

/// The same with a scale, Umeyama's (1991, eq. 42); 1 when the positions do not spread. The
/// transform applies to positions that are scaled already.
Alignment align_sim3(std::span<const PosePair> pairs);

/// Least squares over heading and translation; heading zero when the positions do not spread.
Alignment align_yaw(std::span<const PosePair> pairs);

/// The pose of an estimate scaled and moved into the truth's frame.
Pose aligned(const Pose& estimate, const Alignment& alignment);

/// The pairs with their estimates scaled and moved into the truth's frame.
std::vector<PosePair> aligned(std::vector<PosePair> pairs, const Alignment& alignment);

}  // namespace aims
