// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "core/config.hpp"
#include "core/error.hpp"
#include "core/leg_kinematics.hpp"
#include "core/time.hpp"

namespace aims {

/// The robot's own odometry: legs, encoders, contact detection, its own gyro. A zero switches an
/// error off.
struct LegOdometryConfig {
  double rate = 200.0;  ///< samples per second [Hz]
  FootModel foot_model = FootModel::kPoint;

  double link_length_error = 0.0;       ///< relative, thighs and calves, per run [-]
  double foot_radius_difference = 0.0;  ///< true radius less that of the kinematics [m]
  double joint_stiffness = 0.0;         ///< of transmission and structure, 0: rigid [N m/rad]
  double foot_stiffness = 0.0;          ///< of the rubber foot, 0: rigid [N/m]
  double compliance_time = 0.005;       ///< time constant of the deflection [s]

  double joint_angle_noise = 5e-4;      ///< per sample [rad]
  double joint_angle_offset = 5e-3;     ///< standard deviation of the offset, per run [rad]
  double joint_angle_resolution = 0.0;  ///< smallest step of an encoder, 0: none [rad]
  double joint_rate_noise = 0.05;       ///< per sample [rad/s]
  double joint_rate_window = 0.0;       ///< over which angles are differenced, 0: true rate [s]
  double encoder_delay = 0.0;           ///< of angles and rates behind the sample's stamp [s]

  double contact_on = 20.0;         ///< foot load above which contact is detected [N]
  double contact_off = 10.0;        ///< foot load below which contact is lost [N]
  double load_noise = 2.0;          ///< of the measured load, per sample [N]
  double load_offset = 0.0;         ///< standard deviation, per foot and run [N]
  double load_scale_error = 0.0;    ///< standard deviation, per foot and run [-]
  double load_zero = 0.0;           ///< largest reading without load, per foot and run [N]
  double load_rise_time = 0.0;      ///< time constant of the force sensor under rising load [s]
  double load_hold = 0.0;           ///< for which it keeps the largest load [s]
  double load_fall_time = 0.0;      ///< time constant under falling load [s]
  double load_latency = 0.0;        ///< of the force sensor [s]
  double contact_debounce = 0.010;  ///< from touchdown until contact is reported [s]

  double gyro_noise_density = 2e-4;    ///< [rad/s/sqrt(Hz)]
  double gyro_bias = 1.7e-3;           ///< standard deviation per axis, per run [rad/s]
  double gyro_scale_error = 5e-3;      ///< standard deviation per run [-]
  double velocity_scale = 1.0;         ///< reported over measured velocity, in every run [-]
  double velocity_scale_error = 0.03;  ///< standard deviation of the speed's scale, per run [-]
  double slip_rate = 0.3;              ///< injected slip bursts per second [Hz]
  double slip_speed = 0.15;            ///< standard deviation of a burst's speed error [m/s]
  double slip_duration = 0.2;          ///< of a burst [s]
};
void describe(Fields& f, LegOdometryConfig& c);

/// Error when the rate does not divide the physics rate, or the contact thresholds cross.
Result<void> validate(const LegOdometryConfig& config, Duration timestep);

}  // namespace aims
