// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>

#include "core/config.hpp"
#include "core/measurements.hpp"
#include "estimator/aims/directional_config.hpp"

namespace aims {

/// Inertial prediction (sim has an ImuConfig of its own).
struct ImuPropagationConfig {
  ImuSampling sampling = ImuSampling::kMean;
  double rate_hz = 50.0;                    ///< nominal sample rate [Hz]
  double gravity = 9.81;                    ///< [m/s^2]
  double gyro_noise = 2e-3;                 ///< white noise density [rad/s/sqrt(Hz)]
  double accelerometer_noise = 5e-2;        ///< white noise density [m/s^2/sqrt(Hz)]
  double gyro_bias_walk = 2e-5;             ///< [rad/s^2/sqrt(Hz)]
  double accelerometer_bias_walk = 2e-4;    ///< [m/s^3/sqrt(Hz)]
  double bridge_gyro_noise = 0.3;           ///< density while samples are missing [rad/s/sqrt(Hz)]
  double bridge_accelerometer_noise = 2.0;  ///< while samples are missing [m/s^2/sqrt(Hz)]
  double max_rate = 40.0;                   ///< a faster turn is no measurement [rad/s]
  double max_force = 300.0;                 ///< a greater force is no measurement [m/s^2]
};

/// Standing start.
struct InitializationConfig {
  double duration = 2.0;         ///< of the standing start [s]
  double settle = 1.0;           ///< of it that is left out, while the robot takes its stance [s]
  double still_rate = 0.15;      ///< above it the robot is taken to move [rad/s]
  double still_force = 0.8;      ///< deviation of force above which it moves [m/s^2]
  double sigma_tilt = 5e-3;      ///< [rad]
  double sigma_yaw = 1e-4;       ///< the odometry frame defines yaw [rad]
  double sigma_position = 1e-4;  ///< the odometry frame defines position [m]
  double sigma_velocity = 2e-2;  ///< [m/s]
  double sigma_velocity_moving = 1.0;      ///< of a robot that was not seen standing [m/s]
  double sigma_gyro_bias = 1e-3;           ///< after averaging [rad/s]
  double sigma_accelerometer_bias = 5e-2;  ///< [m/s^2]
};

/// Leg odometry.
struct LegConfig {
  double rate_hz = 200.0;                         ///< nominal packet rate [Hz]
  Eigen::Vector3d velocity_sigma{0.1, 0.1, 0.1};  ///< of one sample, base axes [m/s]
  double correlation_time = 0.1;  ///< of that error: consecutive samples repeat it [s]
  double scale_sigma = 0.05;      ///< error in proportion to speed [-]
  double max_speed = 5.0;         ///< a faster base is no measurement [m/s]
};

/// Point selection, matching and the iterated update (sim has a LidarConfig of its own).
struct LidarUpdateConfig {
  double min_range = 0.3;         ///< [m]
  double max_range = 120.0;       ///< [m]
  double selection_voxel = 0.25;  ///< one point is kept per voxel of the raw scan [m]
  int max_points = 4000;          ///< bound on points per update
  /// Of a point-to-plane residual, R_lidar [m]. Far above the 2 cm of a return: neighbouring
  /// residuals share the errors of map and normals, and are counted as independent.
  double point_sigma = 0.15;
  double residual_gate = 0.2;          ///< larger residuals are refused [m]
  int max_iterations = 4;              ///< of the trial update
  double convergence_rotation = 1e-4;  ///< [rad]
  double convergence_position = 1e-3;  ///< [m]
  double research_rotation = 2e-3;     ///< pose change that renews the neighbours [rad]
  double research_position = 1e-2;     ///< pose change that renews the neighbours [m]
  int min_matches = 30;                ///< fewer planes make no update
};

/// Local map and its planes.
struct MapConfig {
  double voxel_size = 0.5;      ///< hashed voxel; bounds the neighbour search [m]
  double point_spacing = 0.15;  ///< returns closer than this to a map point merge into it [m]
  int max_points_per_voxel = 32;
  int max_merges = 20;              ///< returns that a map point averages before it is frozen
  int max_voxels = 100000;          ///< beyond it the farthest are dropped
  double insertion_voxel = 0.1;     ///< one point is inserted per voxel of the raw scan [m]
  int max_insertions = 12000;       ///< bound on points per scan
  double neighbor_gate = 0.5;       ///< the five neighbours lie within it [m]
  double plane_thickness = 0.06;    ///< the five neighbours lie this close to their plane [m]
  double plane_min_spread = 0.065;  ///< second principal deviation of the neighbours [m]
  double plane_min_ratio = 10.0;    ///< second over smallest principal variance [-]
  double map_sigma = 0.001;         ///< least error of a map point across its plane [m]
};

/// Reliability assessment and adaptive weights, eqs. (3)-(12).
struct DegeneracyConfig {
  bool prior_residuals = false;  ///< O_lidar from residuals before the trial update
  double sigma_0 = 0.008;        ///< nominal residual dispersion, eq. (4) [m]
  double kappa = 12.6;           ///< saturation of C_IL, eq. (7) [-]
  double w1 = 0.5;               ///< weight of 1 - O_lidar, eq. (7); w2 = 1 - w1 [-]
  double eta = 3.0;              ///< LiDAR sensitivity, eq. (8) [-]
  double gamma_min = 0.3;        ///< least leg reliability, eq. (10) [-]
  double alpha = 0.9;            ///< smoothing of D_k per scan, eq. (12) [-]
};

/// Order and completeness of what arrives.
struct QueueConfig {
  double lag = 0.05;       ///< measurements wait this long for earlier ones [s]
  double imu_wait = 0.3;   ///< corrections wait this long for the IMU to cover them [s]
  double max_ahead = 5.0;  ///< a stamp further ahead of its arrival is refused [s]
  int max_held = 5000;     ///< bound on measurements held back
};

/// What tells the members of the family apart; everything else they share.
struct FamilyMember {
  bool leg = true;           ///< fuse leg odometry
  bool hold_lost = false;    ///< repeat the last leg measurement where packets are missing
  bool adaptive = true;      ///< false: gamma = 1, and the index is only recorded
  bool directional = false;  ///< use `EstimatorConfig::directional`
};

/// Everything that the members of the family can be told.
struct EstimatorConfig {
  ImuPropagationConfig imu;
  InitializationConfig initialization;
  LegConfig leg;
  LidarUpdateConfig lidar;
  MapConfig map;
  DegeneracyConfig degeneracy;
  DirectionalConfig directional;
  QueueConfig queue;
};

/// `config` as `member` takes it: without the parts of the directional member for any other.
EstimatorConfig config_of(const FamilyMember& member, EstimatorConfig config);

void describe(Fields& fields, ImuPropagationConfig& config);
void describe(Fields& fields, InitializationConfig& config);
void describe(Fields& fields, LegConfig& config);
void describe(Fields& fields, LidarUpdateConfig& config);
void describe(Fields& fields, MapConfig& config);
void describe(Fields& fields, DegeneracyConfig& config);
void describe(Fields& fields, QueueConfig& config);
void describe(Fields& fields, EstimatorConfig& config);

}  // namespace aims
