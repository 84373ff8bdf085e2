// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "core/config.hpp"
#include "sim/environment/scene_config.hpp"
#include "sim/links/link.hpp"
#include "sim/robot/mounts.hpp"
#include "sim/robot/push.hpp"
#include "sim/robot/robot_config.hpp"
#include "sim/robot/route.hpp"
#include "sim/run_seeds.hpp"
#include "sim/sensors/imu.hpp"
#include "sim/sensors/leg_odometry.hpp"
#include "sim/sensors/lidar_config.hpp"

namespace aims {

/// The integrator of the dynamics.
struct PhysicsConfig {
  double timestep = 0.0025;  ///< [s]
};
void describe(Fields& f, PhysicsConfig& c);

/// Links of the three sensors. By default only leg odometry loses packets.
struct LinksConfig {
  LinkConfig imu;
  LinkConfig leg_odometry = {.loss = 0.05};
  LinkConfig lidar;
};
void describe(Fields& f, LinksConfig& c);

/// Configuration of a simulated run; with the seed it determines every byte of the result.
struct SimulationConfig {
  SceneConfig scene;
  RouteConfig route;
  PhysicsConfig physics;
  RobotConfig robot;
  PushConfig push;
  ImuConfig imu;
  LegOdometryConfig leg_odometry;
  LidarConfig lidar;
  CalibrationErrorConfig calibration;
  LinksConfig links;
  double fast_imu_rate = 0.0;    ///< of the IMU's second output, for recordings; 0: none [Hz]
  double recording_start = 0.0;  ///< the robot walks unrecorded until then [s]
  int robot_seed = 0;            ///< of what belongs to the robot; 0: the run's seed
  /// Names a draw of the sensors' errors of its own, of the same seed; empty: that of the seed.
  std::string sensor_draw;
  double max_duration = 900.0;  ///< simulated time after which the run ends [s]
};
void describe(Fields& f, SimulationConfig& c);

/// The seeds of robot and sensors in a run with that seed; scene, start and pushes have the seed
/// itself.
RunSeeds run_seeds(const SimulationConfig& config, std::uint64_t seed);

/// Error for values that do not fit together, naming the key.
Result<void> validate(const SimulationConfig& config);

}  // namespace aims
