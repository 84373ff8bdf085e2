// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "core/config.hpp"
#include "estimator/degeneracy/degeneracy.hpp"
#include "estimator/degeneracy/noise_information.hpp"
#include "estimator/filter/imu_propagation.hpp"
#include "estimator/filter/measurement_queue.hpp"
#include "estimator/filter/static_initialization.hpp"
#include "estimator/ground/ground_plane.hpp"
#include "estimator/legs/leg_noise.hpp"
#include "estimator/legs/leg_states.hpp"
#include "estimator/legs/leg_velocity_model.hpp"
#include "estimator/legs/zero_velocity.hpp"
#include "estimator/lidar/lidar_config.hpp"

namespace aims {

/// The parts that `aims_d` adds, each with its own switch.
struct DirectionalConfig {
  NoiseInformationConfig noise_information;
  LegStatesConfig leg_states;
  LegNoiseConfig leg_noise;
  StaticInitializationConfig static_initialization;
  ZeroVelocityConfig zero_velocity;
  GroundConstraintConfig ground_constraint;
  RobustKernelConfig robust_kernel;
  MapMemoryConfig map_memory;
};

/// Configuration of all estimators.
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

void describe(Fields& fields, DirectionalConfig& config);
void describe(Fields& fields, EstimatorConfig& config);

/// What distinguishes the variants of the filter.
struct EstimatorVariant {
  bool leg = true;           ///< fuse leg odometry
  bool repeat_lost = false;  ///< repeat the last leg sample while packets are missing
  bool adaptive = true;      ///< false: gamma = 1; the index is computed but not used
  bool directional = false;  ///< use `EstimatorConfig::directional`
};

/// `config` with all directional parts switched off unless the variant uses them.
EstimatorConfig config_for(const EstimatorVariant& variant, EstimatorConfig config);

}  // namespace aims
