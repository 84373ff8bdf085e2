// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "core/config.hpp"
#include "estimator/baselines/leg_kilo/state.hpp"

namespace aims::leg_kilo {

/// Variances of the process noise, per axis and with the square of the time step.
struct ProcessNoise {
  double velocity = 20.0;            ///< [m^2/s^4]
  double force = 500.0;              ///< [m^2/s^6]
  double rate = 1000.0;              ///< [rad^2/s^4]
  double accelerometer_bias = 1e-3;  ///< [m^2/s^6]
  double gyro_bias = 1e-3;           ///< [rad^2/s^4]
};

void describe(Fields& fields, ProcessNoise& config);

/// A measurement of several rows, linear about a state: measured - expected = jacobian error.
struct Observation {
  Eigen::VectorXd innovation;  ///< measured - expected
  Eigen::Matrix<double, Eigen::Dynamic, Error::kSize> jacobian;
  Eigen::VectorXd variance;  ///< of each row

  explicit Observation(Eigen::Index rows);
};

/// The same for rows that depend on the pose alone.
struct PoseObservation {
  Eigen::VectorXd innovation;
  Eigen::Matrix<double, Eigen::Dynamic, Error::kPose> jacobian;
  Eigen::VectorXd variance;
};

/// x [+] error.
State plus(const State& x, const ErrorVector& error);

/// The state `dt` [s] later, with constant specific force and angular rate, by one Euler step.
State predicted(const State& x, double dt);

/// F P F^T + Q of a step of `dt` [s], with the derivative F of that step at `x`. F takes the
/// rotation by the rate in first order, as the published program does.
ErrorMatrix predicted_covariance(const ErrorMatrix& covariance, const State& x, double dt,
                                 const ProcessNoise& noise);

/// The Kalman update in gain form, K = P H^T (H P H^T + R)^-1 and P - K H P.
Belief updated(const Belief& prior, const Observation& observation);
Belief updated(const Belief& prior, const PoseObservation& observation);

/// Whether every number is finite and the position within bounds: indices of voxels stay small.
bool is_usable(const Belief& belief);

}  // namespace aims::leg_kilo
