// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "core/config.hpp"
#include "estimator/baselines/lins/state.hpp"

namespace aims::lins {

/// Standard deviations of the process noise, per axis. As in the published program a step of dt
/// adds the variance (s dt)^2.
struct ProcessNoise {
  double accelerometer = 0.6867;         ///< 70000 ug [m/s^2]
  double gyro = 4.848e-7;                ///< 0.1 deg/h [rad/s]
  double accelerometer_bias = 4.905e-3;  ///< 500 ug in a second [m/s^3]
  double gyro_bias = 1.4544e-5;          ///< 0.05 deg/h^0.5 [rad/s^2]
};

void describe(Fields& fields, ProcessNoise& config);

/// What the IMU measures at an instant, LiDAR axes.
struct Inertial {
  Eigen::Vector3d rate = Eigen::Vector3d::Zero();   ///< [rad/s]
  Eigen::Vector3d force = Eigen::Vector3d::Zero();  ///< specific force [m/s^2]
};

/// The state `dt` [s] later, with the mean rate of both ends and the mean acceleration of both,
/// each at its own attitude.
State predicted(const State& x, const Inertial& begin, const Inertial& end, double dt);

/// Derivative of the error after a step in the error before it, F = I + A dt + A^2 dt^2 / 2 with A
/// at the state after the step.
ErrorMatrix prediction_jacobian(const State& after, const Inertial& end, double dt);

/// Covariance that the noise adds in a step of `dt` [s].
ErrorMatrix prediction_noise(double dt, const ProcessNoise& noise);

/// The belief `dt` [s] later: P <- F P F^T + Q.
Belief predicted(const Belief& belief, const Inertial& begin, const Inertial& end, double dt,
                 const ProcessNoise& noise);

}  // namespace aims::lins
