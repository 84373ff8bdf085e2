// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <span>

#include "core/config.hpp"
#include "core/measurements.hpp"
#include "estimator/filter/imu_noise.hpp"
#include "estimator/filter/kalman_update.hpp"

namespace aims {

/// Error of the mean specific force at the start, besides the bias [m/s^2].
inline constexpr double kSigmaMeanForce = 5e-3;
inline constexpr double kSigmaMeanForceMoving = 0.5;

/// Initialization of a robot that stands still at the start.
struct InitializationConfig {
  double duration = 2.0;          ///< of the standing start; its second half is averaged [s]
  double sigma_gyro_bias = 1e-3;  ///< after averaging [rad/s]
  double sigma_accelerometer_bias = 0.25;  ///< [m/s^2]; ICM-20948: +-50 mg as two sigma
};

void describe(Fields& fields, InitializationConfig& config);

/// Search for the longest undisturbed interval of a standing start.
struct StaticInitializationConfig {
  bool enabled = false;
};

void describe(Fields& fields, StaticInitializationConfig& config);

/// The first belief and its time.
struct InitialBelief {
  Time stamp = 0;
  Belief belief;
  bool stood_still = true;  ///< false: the robot moved; tilt and biases are rough
};

/// The belief at the end of the standing start, i.e. once `samples` span it or the robot moves.
/// The mean specific force gives the tilt, the mean rate the gyro bias. The tilt takes the
/// horizontal accelerometer bias b for gravity, d_rotation = up x (b + error) / g, so both are
/// correlated. The odometry frame is the start pose with yaw 0 and roll and pitch relative to
/// gravity. A robot that moves from the first sample on starts at the newest one, with the tilt of
/// its mean specific force and an unknown velocity. Empty while more samples are needed.
std::optional<InitialBelief> initialize(std::span<const ImuSample> samples,
                                        const InitializationConfig& config, double gravity);

/// The same for a start that may be disturbed: averages the longest interval whose samples stay
/// close to their own mean, in direction as well as magnitude, so that a lateral push is not taken
/// as tilt. The start ends at the first disturbance after the settling time.
std::optional<InitialBelief> initialize_static(std::span<const ImuSample> samples,
                                               const InitializationConfig& config, double gravity);

}  // namespace aims
