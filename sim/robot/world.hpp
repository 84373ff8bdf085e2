// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <array>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "core/error.hpp"
#include "core/leg_kinematics.hpp"
#include "core/lie.hpp"
#include "core/measurements.hpp"
#include "sim/robot/robot_geometry.hpp"

namespace aims {

/// Everything that defines a world.
struct WorldSetup {
  std::string mjcf;            ///< a robot (see RobotModel) with the scene's solids around it
  std::vector<float> heights;  ///< of the height field in [0, 1], row by row; empty: flat floor
  double timestep = 0.0025;    ///< of the integrator [s]
  double friction = 0.7;       ///< of the feet on the floor [-]
  LegGeometries legs = kNominalLegs;   ///< as built
  LegGeometry drawn = kRobotGeometry;  ///< as the gait controller and the estimators have them
  double body_height = 0.29;           ///< of the trunk's centre over the ground at the start [m]
  double stance_width = 0.09;          ///< of a foot beside its hip at the start [m]
};

/// State of the robot after a physics step. The base frame is the trunk's centre.
struct RobotState {
  Time stamp = 0;
  Pose T_world_base;
  Eigen::Vector3d velocity = Eigen::Vector3d::Zero();          ///< of the base in the world [m/s]
  Eigen::Vector3d angular_velocity = Eigen::Vector3d::Zero();  ///< in base axes [rad/s]
  JointVector q = JointVector::Zero();                         ///< joint angles [rad]
  JointVector qd = JointVector::Zero();                        ///< joint rates [rad/s]
  FootLoads foot_load{};                                       ///< in the last step
  /// Force of the floor on each foot in the last step, in the world [N]
  std::array<Eigen::Vector3d, kLegCount> foot_force{
      Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero(),
      Eigen::Vector3d::Zero()};
  bool trunk_on_floor = false;  ///< a part other than feet and calves touches the floor
  bool touches_wall = false;    ///< any part touches a solid other than the floor
};

/// Mass properties of the whole robot, standing with its legs in the nominal position, and its
/// dimensions.
struct BodyModel {
  double mass = 0.0;                                      ///< [kg]
  Eigen::Vector3d com_in_base = Eigen::Vector3d::Zero();  ///< centre of mass [m]
  Eigen::Matrix3d inertia = Eigen::Matrix3d::Identity();  ///< about it, base axes [kg m^2]
  LegGeometry legs = kRobotGeometry;                      ///< as drawn
};

/// Joint angles [rad] with every foot `height` [m] below the base and `lateral` [m] outside the
/// hip.
JointVector standing_joints(const LegGeometry& legs, double height, double lateral);

/// The dynamics of one robot in one scene, stepped at a fixed rate.
class World {
 public:
  /// Error when the model does not load or has no quadruped in it.
  static Result<World> create(const WorldSetup& setup);
  World(World&&) noexcept;
  World& operator=(World&&) noexcept;
  ~World();

  /// Puts the robot at rest at (x, y) [m] with the heading `yaw` [rad], feet just above the highest
  /// floor beneath it. Time restarts at zero.
  void place(double x, double y, double yaw);

  /// One physics step under those joint torques [N m], limited by the motors.
  void step(const JointVector& torques);

  /// Calls the present instant time zero.
  void restart_clock();

  /// Applies a force in the world frame [N] to the trunk during the following steps.
  void push(const Eigen::Vector3d& force);

  const RobotState& state() const;
  Duration timestep() const;
  const BodyModel& body() const;

  /// Frame of a site of the model, such as "imu", in the base frame.
  Pose T_base_site(std::string_view site) const;

  /// Speed of each foot's contact patch over the ground [m/s]; zero for an unloaded foot.
  std::array<double, kLegCount> slip_speed() const;

  /// True when a part of the robot is inside a solid (the floor does not count).
  bool robot_inside_solid() const;

  std::vector<double> qpos() const;  ///< MuJoCo's generalized positions
  int warning_count() const;         ///< of the physics engine so far, e.g. an unstable step

 private:
  struct Impl;
  explicit World(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

}  // namespace aims
