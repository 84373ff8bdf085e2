// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "core/measurements.hpp"
#include "estimator/aims/config.hpp"
#include "estimator/filter/kalman_update.hpp"

namespace aims {

/// What leg odometry reports of one interval.
struct LegVelocity {
  Eigen::Vector3d measured = Eigen::Vector3d::Zero();     ///< velocity of its base, base axes [m/s]
  Eigen::Vector3d stride_mean = Eigen::Vector3d::Zero();  ///< its mean over the last stride [m/s]
};

/// Leg odometry as relative motion over its interval: u + scale u_mean + bias, axis by axis, of the
/// velocity u of the leg odometry's base in base axes, R_body_base^T (R^T v + (omega - b_g) x
/// p_body_base). The scale is one of the way, not of the swing within a stride: there the IMU knows
/// better than the legs, and would seem to tell their scale.
/// `angular_velocity` is the gyro's reading in body axes [rad/s].
LinearMeasurement leg_velocity_model(const NominalState& state, const Pose& T_body_base,
                                     const Eigen::Vector3d& angular_velocity,
                                     const LegVelocity& legs, const Eigen::Matrix3d& noise);

/// R_leg, the nominal covariance of one sample [m^2/s^2]. The error of leg odometry lasts (a scale,
/// a slipping stance), so consecutive samples repeat it; the sample's variance grows by the number
/// of samples per correlation time, so that a second of samples weighs what it is worth.
Eigen::Matrix3d leg_velocity_noise(const LegConfig& config, const Eigen::Vector3d& measured);

}  // namespace aims
