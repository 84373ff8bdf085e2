// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "core/config.hpp"
#include "estimator/baselines/fast_lio2/state.hpp"

namespace aims::fast_lio2 {

/// Variances of the process noise, as the publication's program sets them: per axis and with the
/// square of the time step.
struct ProcessNoise {
  double gyro = 0.1;                 ///< [rad^2/s^2]
  double accelerometer = 0.1;        ///< [m^2/s^4]
  double gyro_bias = 1e-4;           ///< [rad^2/s^4]
  double accelerometer_bias = 1e-4;  ///< [m^2/s^6]
};

void describe(Fields& fields, ProcessNoise& config);

/// State and covariance.
struct Belief {
  State state;
  ErrorMatrix covariance = ErrorMatrix::Identity();
};

/// Constant angular rate and specific force over a step, biases included.
struct Inertial {
  Eigen::Vector3d rate = Eigen::Vector3d::Zero();   ///< body axes [rad/s]
  Eigen::Vector3d force = Eigen::Vector3d::Zero();  ///< body axes [m/s^2]
};

/// The state `dt` [s] later by one Euler step on the manifold, x [+] f(x, u) dt.
State predicted(const State& x, const Inertial& input, double dt);

/// Derivative of the error after the step in the error before it.
ErrorMatrix prediction_jacobian(const State& x, const Inertial& input, double dt);

/// Covariance that the noise adds in a step of `dt` [s].
ErrorMatrix prediction_noise(const State& x, const Inertial& input, double dt,
                             const ProcessNoise& noise);

/// The belief `dt` [s] later: P <- F P F^T + Q.
Belief predicted(const Belief& belief, const Inertial& input, double dt, const ProcessNoise& noise);

}  // namespace aims::fast_lio2
