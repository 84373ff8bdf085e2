// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "core/trajectory.hpp"
#include "estimator/interface/motion.hpp"
#include "recordings/messages/message_encoding.hpp"

namespace aims {

/// The pose `to` with the mean twist since `from`, in the axes of `to`; covariances unknown.
OdometryContent odometry_between(const StampedPose& from, const StampedPose& to);

/// The motion in the frames that nav_msgs/Odometry defines: the covariance of the pose about the
/// fixed axes of the odometry frame, twist and its covariance in the axes of the body.
OdometryContent odometry_of(const MotionEstimate& motion);

/// The pose with its heading and position alone.
Pose level(const Pose& pose);

/// The motion in the frame in which its odometry frame has the level pose `T_frame_odom`.
MotionEstimate placed_at(const Pose& T_frame_odom, const MotionEstimate& motion);

}  // namespace aims
