// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "core/scan_information.hpp"
#include "core/trajectory.hpp"

namespace aims {

/// True white noise and bias of one inertial triad; unit: rad/s or m/s^2.
struct TriadErrors {
  double noise_density = 0.0;  ///< [unit/sqrt(Hz)]
  double bias_walk = 0.0;      ///< [unit/sqrt(s)]
  double bias_sigma = 0.0;     ///< of the bias at the start [unit]
};

/// Errors of the leg odometry in the model of the bound.
struct LegErrors {
  bool used = true;
  double packets_per_second = 200.0;  ///< received on average [Hz]
  double velocity_sigma = 0.01;       ///< white, of one packet and axis [m/s]
  double scale_sigma = 0.03;          ///< of the run's constant scale [-]
};

/// Prior standard deviations at the first true pose: the odometry frame defines position and
/// heading, as errors are aligned there; the other states are estimated.
struct InitialKnowledge {
  double position_sigma = 1e-6;  ///< [m]
  double heading_sigma = 1e-6;   ///< [rad]
  double tilt_sigma = 0.1;       ///< [rad]
  double velocity_sigma = 1e-2;  ///< [m/s]
};

/// The parameters of the simulated sensors that the posterior bound needs.
struct BoundParameters {
  TriadErrors gyro;
  TriadErrors accelerometer;
  LegErrors legs;
  bool lidar = true;  ///< false: without the scans' information
  InitialKnowledge initial;
  Pose T_body_base;  ///< frame of the leg odometry in the body frame
};

/// The true motion at one instant.
struct TrueMotion {
  Time stamp = 0;
  Pose T_world_body;
  Eigen::Vector3d velocity = Eigen::Vector3d::Zero();          ///< of the body in the world [m/s]
  Eigen::Vector3d angular_velocity = Eigen::Vector3d::Zero();  ///< in body axes [rad/s]
};

/// Lower bound of the standard deviation of any unbiased estimate at the end of one scan.
struct PosteriorBound {
  Time stamp = 0;
  Eigen::Matrix3d position = Eigen::Matrix3d::Zero();  ///< covariance, world axes [m^2]
  double longitudinal = 0.0;                           ///< along the body's heading [m]
  double lateral = 0.0;                                ///< to its left [m]
  double vertical = 0.0;                               ///< [m]
  double heading = 0.0;                                ///< [rad]
  double leg_scale = 0.0;                              ///< of the leg odometry's scale [-]
};

/// Standard deviation [m] along the unit `axis` (world).
double bound_along(const PosteriorBound& bound, const Eigen::Vector3d& axis);

/// Posterior Cramer-Rao bound over a run (the information recursion of Tichavsky, Muravchik and
/// Nehorai 1998, in covariance form): IMU, legs and LiDAR linearised at the true motion. State:
/// rotation, position, velocity, both IMU biases and the constant scale of the legs. `motion` has
/// increasing stamps, finely enough to integrate (20 ms); `scans` are in order of time, and only
/// those inside the motion's span count. One entry per scan, with or without `lidar`.
/// The LiDAR is matched to a known map, so no SLAM system reaches the bound: for those see
/// `unknown_map_bounds`. The leg model has no slip, rolling feet, joint offsets or late touchdown:
/// real legs are worse.
std::vector<PosteriorBound> posterior_bounds(std::span<const TrueMotion> motion,
                                             std::span<const ScanInformation> scans,
                                             const BoundParameters& parameters);

}  // namespace aims
