// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <deque>
#include <optional>

#include "core/config.hpp"
#include "core/measurements.hpp"
#include "estimator/filter/imu_noise.hpp"
#include "estimator/filter/kalman_update.hpp"

namespace aims {

/// Initialization of a robot that stands still at the start.
struct InitializationConfig {
  double duration = 2.0;             ///< of the standing start [s]
  double settling_time = 1.0;        ///< initial part that is not averaged [s]
  double max_rate = 0.15;            ///< a faster turn is motion [rad/s]
  double max_force_deviation = 0.8;  ///< larger deviations from gravity are motion [m/s^2]
  /// Error of the mean specific force of a standing start, besides the bias [m/s^2].
  double sigma_mean_force = 5e-3;
  double sigma_mean_force_moving = 0.5;   ///< of a start in motion [m/s^2]
  double sigma_yaw = 1e-4;                ///< the odometry frame defines yaw [rad]
  double sigma_position = 1e-4;           ///< the odometry frame defines position [m]
  double sigma_velocity = 2e-2;           ///< [m/s]
  double sigma_velocity_moving = 1.0;     ///< after a start in motion [m/s]
  double sigma_gyro_bias = 1e-3;          ///< after averaging [rad/s]
  double sigma_accelerometer_bias = 0.25;  ///< [m/s^2]; ICM-20948: +-50 mg as two sigma
};

void describe(Fields& fields, InitializationConfig& config);

/// Search for the longest undisturbed interval of a standing start.
struct StaticInitializationConfig {
  bool enabled = false;
  double max_force_deviation = 0.1;  ///< from the interval's mean; more ends the interval [m/s^2]
  double min_duration = 0.2;         ///< of an interval that gives the tilt [s]
  /// Of an interval that gives the gyro bias [s]: 5 mrad of sway in 0.3 s are 17 mrad/s.
  double min_duration_gyro_bias = 0.9;
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
std::optional<InitialBelief> initialize(const std::deque<ImuSample>& samples,
                                        const InitializationConfig& config, double gravity);

/// The same for a start that may be disturbed: averages the longest interval whose samples stay
/// close to their own mean, in direction as well as magnitude, so that a lateral push is not taken
/// as tilt. The start ends at the first disturbance after the settling time.
std::optional<InitialBelief> initialize_static(const std::deque<ImuSample>& samples,
                                               const InitializationConfig& config,
                                               const StaticInitializationConfig& limits,
                                               double gravity);

}  // namespace aims
