// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "core/config.hpp"
#include "core/measurements.hpp"
#include "estimator/filter/kalman_update.hpp"

namespace aims {

/// Correlation time of the error of a leg sample, which consecutive samples share [s].
inline constexpr double kLegCorrelationTime = 0.1;

/// Leg odometry.
struct LegConfig {
  bool enabled = true;
  bool repeat_lost = false;                       ///< zero-order hold of lost packets
  Eigen::Vector3d velocity_sigma{0.1, 0.1, 0.1};  ///< of one sample, base axes [m/s]
  double scale_sigma = 0.05;                      ///< error proportional to the speed [-]
};

void describe(Fields& fields, LegConfig& config);

/// Velocity reported by leg odometry.
struct LegVelocity {
  Eigen::Vector3d measured = Eigen::Vector3d::Zero();     ///< of the base, base axes [m/s]
  Eigen::Vector3d stride_mean = Eigen::Vector3d::Zero();  ///< its mean over strides, no lag [m/s]
  Eigen::Vector3d past_mean = Eigen::Vector3d::Zero();    ///< mean of past samples, lags [m/s]
};

/// Leg odometry as relative motion over its interval: the measured velocity is
/// u + scale u_mean + bias per axis, with the base velocity in base axes
/// u = R_body_base^T (R^T v + (omega - b_g) x p_body_base). The scale multiplies the mean over
/// strides: within a stride the IMU measures the velocity better than the legs, and the difference
/// would be taken as scale. So would the noise that mean and sample share: the Jacobian takes the
/// mean of past samples, an instrumental variable (docs/decisions.md). `angular_velocity` is the
/// gyro's reading in body axes [rad/s].
LinearMeasurement leg_velocity_model(const NominalState& state, const Pose& T_body_base,
                                     const Eigen::Vector3d& angular_velocity,
                                     const LegVelocity& legs, const Eigen::Matrix3d& noise);

/// The residual of that measurement without the scale and bias of `state`: velocity of the state
/// minus the velocity reported [m/s].
Eigen::Vector3d uncorrected_residual(const LinearMeasurement& measurement,
                                     const NominalState& state, const LegVelocity& legs);

/// R_leg, the nominal covariance of one sample [m^2/s^2] at `rate_hz` [Hz], times the consecutive
/// samples that share one error (a slipping stance): 2 tau f, at least 1. `speed` [m/s] is that of
/// the filter: with the speed of the sample itself fast samples would weigh less than slow ones.
Eigen::Matrix3d leg_velocity_noise(const LegConfig& config, double rate_hz, double speed);

}  // namespace aims
