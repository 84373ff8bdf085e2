// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "core/measurements.hpp"
#include "estimator/config.hpp"
#include "estimator/kalman_update.hpp"

namespace aims {

/// Leg odometry as relative motion over its interval: (1 + scale) u + bias, axis by axis, of the
/// velocity u of the leg odometry's base in base axes, R_body_base^T (R^T v + (omega - b_g) x
/// p_body_base).
/// `measured` is that velocity [m/s], `angular_velocity` the gyro's reading in body axes [rad/s].
LinearMeasurement leg_velocity_model(const NominalState& state, const Pose& T_body_base,
                                     const Eigen::Vector3d& angular_velocity,
                                     const Eigen::Vector3d& measured, const Eigen::Matrix3d& noise);

/// R_leg, the nominal covariance of one sample [m^2/s^2]. The error of leg odometry lasts (a scale,
/// a slipping stance), so consecutive samples repeat it; the sample's variance grows by the number
/// of samples per correlation time, so that a second of samples weighs what it is worth.
Eigen::Matrix3d leg_velocity_noise(const LegConfig& config, const Eigen::Vector3d& measured);

}  // namespace aims
