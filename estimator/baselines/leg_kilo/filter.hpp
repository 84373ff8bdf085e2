// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>

#include "core/config.hpp"
#include "core/lie.hpp"

namespace aims::leg_kilo {

/// State of the filter. Specific force and angular rate are states, which the IMU measures. The
/// world is the IMU's frame at the start, so gravity is a vector in it.
struct State {
  Pose T_world_body;                                             ///< of the IMU
  Eigen::Vector3d velocity = Eigen::Vector3d::Zero();            ///< v_world_body [m/s]
  Eigen::Vector3d accelerometer_bias = Eigen::Vector3d::Zero();  ///< [m/s^2]
  Eigen::Vector3d gyro_bias = Eigen::Vector3d::Zero();           ///< [rad/s]
  Eigen::Vector3d gravity = -9.81 * Eigen::Vector3d::UnitZ();    ///< in the world [m/s^2]
  Eigen::Vector3d force = Eigen::Vector3d::Zero();               ///< specific, body axes [m/s^2]
  Eigen::Vector3d rate = Eigen::Vector3d::Zero();                ///< body axes [rad/s]
};

/// Blocks of the error state, three entries each; the rotation is disturbed on the right.
struct Error {
  static constexpr int kRotation = 0;
  static constexpr int kPosition = 3;
  static constexpr int kVelocity = 6;
  static constexpr int kAccelerometerBias = 9;
  static constexpr int kGyroBias = 12;
  static constexpr int kGravity = 15;
  static constexpr int kForce = 18;
  static constexpr int kRate = 21;
  static constexpr int kSize = 24;
  static constexpr int kPose = 6;  ///< a point depends on the blocks before the velocity
};

using ErrorVector = Eigen::Matrix<double, Error::kSize, 1>;
using ErrorMatrix = Eigen::Matrix<double, Error::kSize, Error::kSize>;

/// State and covariance of its error.
struct Belief {
  State state;
  ErrorMatrix covariance = ErrorMatrix::Identity();
};

/// The 3x3 block of two blocks of the error state.
inline Eigen::Matrix3d part(const ErrorMatrix& matrix, int row, int column) {
  return matrix.block<3, 3>(row, column);
}

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
