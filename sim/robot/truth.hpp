// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "core/measurements.hpp"
#include "core/scan_information.hpp"
#include "core/trajectory.hpp"
#include "core/walk_outcome.hpp"
#include "sim/robot/mounts.hpp"

namespace aims {

/// The true state of the robot at one physics step.
struct TruthSample {
  Time stamp = 0;
  Pose T_world_body;                                             ///< body = IMU frame
  Eigen::Vector3d velocity = Eigen::Vector3d::Zero();            ///< of the body in the world [m/s]
  Eigen::Vector3d angular_velocity = Eigen::Vector3d::Zero();    ///< in body axes [rad/s]
  Eigen::Vector3d gyro_bias = Eigen::Vector3d::Zero();           ///< [rad/s]
  Eigen::Vector3d accelerometer_bias = Eigen::Vector3d::Zero();  ///< [m/s^2]
  std::array<double, kLegCount> slip_speed{};  ///< of each foot in contact over the ground [m/s]
};

/// Configuration of the whole robot, for pictures.
struct RobotSnapshot {
  Time stamp = 0;
  std::vector<double> qpos;  ///< MuJoCo generalized positions of the quadruped
};

/// The ground truth of a run, separate from the measurements: no estimator receives it.
struct Truth {
  std::vector<TruthSample> samples;          ///< at the physics rate
  std::vector<RobotSnapshot> snapshots;      ///< at 10 Hz
  std::vector<WaypointTime> waypoint_times;  ///< of the route's named points, in order
  std::vector<ScanInformation> scans;        ///< of the scans that were delivered
  WalkOutcome walk;
  Mounts mounts;  ///< of IMU and LiDAR, as they really are
};

/// The true poses of the body alone.
Trajectory body_trajectory(const Truth& truth);

}  // namespace aims
