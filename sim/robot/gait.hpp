// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <array>

#include "core/config.hpp"
#include "sim/robot/stance_forces.hpp"
#include "sim/robot/swing_path.hpp"
#include "sim/robot/trunk_motion.hpp"
#include "sim/robot/world.hpp"

namespace aims {

/// Trot gait and trunk controller.
struct GaitConfig {
  double period = 0.433;         ///< of a stride; a multiple of 20 ms aliases into a 50 Hz IMU [s]
  double duty_factor = 0.58;     ///< fraction of the period that a foot is on the ground [-]
  double body_height = 0.29;     ///< of the trunk's centre over the ground [m]
  double swing_height = 0.06;    ///< of a foot in mid-swing [m]
  double stance_width = 0.09;    ///< of a foot beside its hip [m]
  double velocity_gain = 12.0;   ///< [1/s]
  double height_gain = 120.0;    ///< [1/s^2]
  double height_damping = 16.0;  ///< [1/s]
  double attitude_gain = 150.0;  ///< roll and pitch [1/s^2]
  double attitude_damping = 15.0;  ///< roll, pitch and yaw rates [1/s]
  double standing_gain = 60.0;     ///< position and heading while standing [1/s^2]
  double integral_gain = 0.8;      ///< of velocity and yaw rate [1/s]
  double acceleration = 1.0;       ///< limit of the velocity command [m/s^2]
  double yaw_acceleration = 3.0;   ///< limit of the yaw-rate command [rad/s^2]
  double swing_stiffness = 80.0;   ///< of a joint while its foot swings [N m/rad]
  double swing_damping = 2.0;      ///< of the same [N m s/rad]
  double contact_load = 15.0;      ///< of a swinging foot, above which it has touched down [N]
  SwingPathConfig swing;
  StanceHoldConfig hold;
  TrunkMotionConfig trunk;
  StanceForceConfig forces;
};
void describe(Fields& f, GaitConfig& c);

/// Velocity command in the heading frame of the robot.
struct VelocityCommand {
  Eigen::Vector2d velocity = Eigen::Vector2d::Zero();  ///< forward, left [m/s]
  double yaw_rate = 0.0;                               ///< [rad/s]
};

/// Stands, trots and turns by distributing forces over the standing feet.
class GaitController {
 public:
  GaitController(const GaitConfig& config, const BodyModel& body, double timestep);

  /// Joint torques [N m] for the present state; call once per physics step.
  JointVector torques(const RobotState& state, const VelocityCommand& command);

  /// All four feet stand and the robot holds its place.
  bool standing() const { return standing_; }

 private:
  struct View;  ///< the state in world axes
  void limit_command(const VelocityCommand& command, const View& now);
  void integrate_errors(const View& now);
  void advance_phase(const RobotState& state, const VelocityCommand& command, const View& now);
  void schedule_feet(const RobotState& state, const View& now);
  void begin_standing(const View& now);
  void follow_feet(const View& now);
  StanceProblem stance_problem(const View& now) const;
  void move_trunk(const View& now, Eigen::Vector3d& linear, Eigen::Vector3d& angular) const;
  Eigen::Vector3d touchdown(int leg, const View& now) const;
  Eigen::Vector3d swing_torques(int leg, const RobotState& state, const View& now) const;
  double leg_phase(int leg) const;
  double swing_progress(int leg) const;
  Eigen::Vector3d desired_velocity(const View& now) const;

  GaitConfig config_;
  BodyModel body_;
  double dt_;
  bool started_ = false;
  bool standing_ = true;
  double phase_ = 0.0;      ///< of the stride, in [0, 1)
  double idle_time_ = 0.0;  ///< since the command became zero [s]
  double motion_ = 0.0;     ///< share of the trunk's motion, 0 to 1
  double ground_ = 0.0;     ///< height under the feet [m]
  VelocityCommand target_;  ///< rate-limited command
  Eigen::Vector2d velocity_integral_ = Eigen::Vector2d::Zero();
  double yaw_rate_integral_ = 0.0;
  Eigen::Vector2d hold_position_ = Eigen::Vector2d::Zero();  ///< world [m]
  double hold_yaw_ = 0.0;
  StanceHold hold_feet_;
  std::array<bool, kLegCount> stands_{};
  std::array<bool, kLegCount> latched_{};             ///< touched down early
  std::array<Eigen::Vector3d, kLegCount> liftoff_{};  ///< where the swing began, world [m]
};

}  // namespace aims
