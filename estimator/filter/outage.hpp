// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "estimator/filter/imu_propagation.hpp"
#include "estimator/filter/kalman_update.hpp"

namespace aims {

/// Missing IMU samples are replaced by those around them for so long [s]. After a longer time, over
/// which nothing else was measured either, the motion is unknown.
inline constexpr double kLongestBridge = 0.4;

/// Whether `segment` replaces samples for so long.
bool is_outage(const InertialSegment& segment);

/// The belief after `duration` [s] in which no sensor measured: the velocity decays, the attitude
/// stays, and both, with the position, get the deviation of a robot that walks or turns as it
/// likes.
Belief after_outage(const Belief& belief, double duration);

/// How far the heading may be off after such a time [rad], at most half a turn.
double heading_reach(double outage);

/// `state` turned by `angle` [rad] about the vertical through the body.
NominalState turned(const NominalState& state, double angle);

}  // namespace aims
