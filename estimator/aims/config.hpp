// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "core/config.hpp"
#include "estimator/aims/robot_prior.hpp"
#include "estimator/degeneracy/cross_validation.hpp"
#include "estimator/degeneracy/degeneracy.hpp"
#include "estimator/filter/imu_propagation.hpp"
#include "estimator/filter/measurement_queue.hpp"
#include "estimator/filter/static_initialization.hpp"
#include "estimator/ground/ground_plane.hpp"
#include "estimator/interface/estimator_config.hpp"
#include "estimator/legs/feet.hpp"
#include "estimator/legs/leg_states.hpp"
#include "estimator/legs/leg_velocity_model.hpp"
#include "estimator/legs/zero_velocity.hpp"
#include "estimator/lidar/lidar_config.hpp"
#include "estimator/lidar/sensor_calibration.hpp"

namespace aims {

/// Configuration of the error-state Kalman filter. Each part has a switch, off by default: the
/// defaults fuse LiDAR, IMU and legs with fixed weights. Presets: estimator/aims/presets.hpp.
struct EskfConfig {
  ImuPropagationConfig imu;
  InitializationConfig initialization;
  StaticInitializationConfig static_initialization;
  LegConfig legs;
  FeetConfig feet;
  LegStatesConfig leg_states;
  ZeroVelocityConfig zero_velocity;
  GroundConstraintConfig ground_constraint;
  LidarUpdateConfig lidar;
  CalibrationConfig calibration;
  RobustKernelConfig robust_kernel;
  MapConfig map;
  MapCovarianceConfig map_covariance;
  DegeneracyConfig degeneracy;
  CrossValidationConfig cross_validation;
  QueueConfig queue;
  RobotPriorConfig prior;
};

/// Also states which settings have no effect under which others.
void describe(Fields& fields, EskfConfig& config);

Requirements requirements_of(const EskfConfig& config);

/// Whether legs are compared with scans, which a second belief has.
bool measures_legs(const EskfConfig& config);

/// Error for values that do not go together.
Result<void> check(const EskfConfig& config);

/// What of the calibration is estimated. On level ground a tilt of the mount acts as a bias of the
/// accelerometer does, and nothing measures its heading: with the ground constraint the mount is
/// known, with a deviation of zero (docs/decisions.md).
CalibrationConfig estimated_calibration(const EskfConfig& config);

/// Deviation of the attitude, per axis, that a mount which is not estimated adds [rad].
double sigma_of_fixed_mount(const EskfConfig& config);

}  // namespace aims
