// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "estimator/filter/imu_propagation.hpp"
#include "estimator/filter/kalman_update.hpp"

namespace aims {

/// Missing IMU samples are replaced by those around them for so long [s]. After a longer time
/// without scans the heading is unknown, and without any measurement the motion too.
inline constexpr double kLongestBridge = 0.4;

/// Whether `segment`, between two measurements of any sensor, has no samples for so long.
bool is_outage(const InertialSegment& segment);

/// The belief after `duration` [s] in which no sensor measured: the velocity decays, the attitude
/// stays, and tilt, velocity and position get the deviation of a robot that walks as it likes.
Belief after_outage(const Belief& belief, double duration);

/// How far the heading may be off after `duration` [s] without IMU and scans: at most half a turn
/// [rad].
double heading_reach(double duration);

/// The belief whose heading was unmeasured for `before` [s] and now is for `duration`.
Belief with_unmeasured_heading(const Belief& belief, double before, double duration);

/// `state` turned by `angle` [rad] about the vertical through the body.
NominalState turned(const NominalState& state, double angle);

}  // namespace aims
