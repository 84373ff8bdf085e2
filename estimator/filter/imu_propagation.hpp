// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "core/config.hpp"
#include "core/measurements.hpp"
#include "core/time.hpp"
#include "estimator/filter/error_state.hpp"
#include "estimator/filter/imu_noise.hpp"
#include "estimator/filter/kalman_update.hpp"

namespace aims {

/// Inertial prediction; the white noise is estimated (imu_noise.hpp).
struct ImuPropagationConfig {
  double gravity = 9.81;                  ///< [m/s^2]
  double gyro_bias_walk = 2e-5;           ///< [rad/s^2/sqrt(Hz)]
  double accelerometer_bias_walk = 2e-4;  ///< [m/s^3/sqrt(Hz)]
};

void describe(Fields& fields, ImuPropagationConfig& config);

/// A time span over which angular rate and specific force (body axes, bias included) are constant.
struct InertialSegment {
  Time begin = 0;
  Time end = 0;
  Eigen::Vector3d angular_velocity = Eigen::Vector3d::Zero();  ///< [rad/s]
  Eigen::Vector3d specific_force = Eigen::Vector3d::Zero();    ///< [m/s^2]
  bool measured = true;                                        ///< false: replaces missing samples
  ImuNoiseDensity noise;                                       ///< white
};

/// The nominal state `dt` [s] later (earlier when negative): exact for constant rate and force.
NominalState propagate_state(const NominalState& state, const InertialSegment& segment, double dt,
                             double gravity);

/// Jacobian F of the error after `dt` [s] with respect to the error before it.
ErrorMatrix propagation_jacobian(const NominalState& state, const InertialSegment& segment,
                                 double dt);

/// Covariance Q that `dt` [s] of inertial noise and bias random walk add. It is isotropic, so body
/// and odometry axes give the same.
ErrorMatrix propagation_noise(const ImuPropagationConfig& config, const ImuNoiseDensity& white,
                              double dt);

/// The belief `dt` [s] later: P <- F P F^T + Q.
Belief propagate(const Belief& belief, const InertialSegment& segment, double dt,
                 const ImuPropagationConfig& config);

}  // namespace aims
