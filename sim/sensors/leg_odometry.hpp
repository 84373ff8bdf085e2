// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>

#include "core/leg_kinematics.hpp"
#include "core/measurements.hpp"
#include "core/random.hpp"
#include "sim/robot/world.hpp"
#include "sim/run_seeds.hpp"
#include "sim/sensors/contact_sensor.hpp"
#include "sim/sensors/joint_encoders.hpp"
#include "sim/sensors/leg_compliance.hpp"
#include "sim/sensors/leg_odometry_config.hpp"

namespace aims {

/// Errors that are constant in a run.
struct LegRunErrors {
  double velocity_scale = 1.0;                          ///< reported over measured velocity
  double gyro_scale = 1.0;                              ///< measured over true rate
  Eigen::Vector3d gyro_bias = Eigen::Vector3d::Zero();  ///< [rad/s]
  JointVector angle_offset = JointVector::Zero();       ///< of the encoders [rad]
};

/// Simulates the robot's leg odometry from its true state. Heading integrates the gyro alone; roll
/// and pitch are corrected by gravity, as by an attitude filter.
class LegOdometry {
 public:
  /// `config` is valid; `legs` as drawn. Random streams: "leg.gyro", "leg.slip", of the robot
  /// "leg.run", and those of the parts.
  LegOdometry(const LegOdometryConfig& config, const LegGeometry& legs, Duration timestep,
              RunSeeds seeds);

  /// Processes the true state before the first and after each physics step; returns a sample at
  /// the end of each interval.
  std::optional<LegOdometrySample> sample(const RobotState& truth);

 private:
  void begin(const RobotState& truth);
  void measure_rotation(const RobotState& truth, LegOdometrySample& sample);
  Eigen::Vector3d foot_velocity(int leg, const LegOdometrySample& sample) const;
  Eigen::Vector3d body_velocity(const LegOdometrySample& sample);
  Eigen::Vector3d slip_error(const Eigen::Vector3d& velocity);

  LegOdometryConfig config_;
  LegGeometry legs_;
  int steps_;
  double interval_;  ///< [s]
  LegRunErrors errors_;
  LegCompliance compliance_;
  JointEncoders encoders_;
  ContactSensor contacts_;
  RandomStream gyro_, slip_;

  bool started_ = false;
  int count_ = 0;
  Eigen::Quaterniond last_rotation_ = Eigen::Quaterniond::Identity();  ///< true, a sample ago
  Pose T_odom_base_;
  Eigen::Vector3d velocity_ = Eigen::Vector3d::Zero();  ///< last estimate, base axes [m/s]
  double slip_left_ = 0.0;                              ///< of the present burst [s]
  double slip_size_ = 0.0;                              ///< of the present burst [m/s]
};

}  // namespace aims
