// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <deque>
#include <optional>

#include "core/measurements.hpp"
#include "estimator/aims/config.hpp"
#include "estimator/filter/kalman_update.hpp"

namespace aims {

/// The first belief and the instant to which it belongs.
struct InitialBelief {
  Time stamp = 0;
  Belief belief;
  bool stood_still = true;  ///< false: the robot moved, so tilt and biases are guesses
};

/// The belief at the end of the standing start: once `samples` span it, or once the robot moves.
/// A robot that moves from the first sample on starts at the newest one, level by the mean force of
/// a gait that carries its weight, with a velocity that only measurements can tell.
/// Gyro bias and tilt come from their means; the odometry frame is the start pose with yaw 0 and
/// roll and pitch against gravity. Empty while more samples are needed.
std::optional<InitialBelief> initialize(const std::deque<ImuSample>& samples,
                                        const InitializationConfig& config, double gravity);

/// The same for a robot that may be shoved meanwhile: from the longest stretch of samples that keep
/// close to their own mean, in direction as well as size, so that a shove from the side does not
/// pass for a tilt. The stand ends at the first disturbance after settling.
std::optional<InitialBelief> initialize_quietly(const std::deque<ImuSample>& samples,
                                                const InitializationConfig& config,
                                                const StartConfig& quiet, double gravity);

}  // namespace aims
