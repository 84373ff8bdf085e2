// SPDX-License-Identifier: BSD-3-Clause
#include "sim/robot/gait.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

namespace aims {
namespace {

constexpr double kGravity = 9.81;            ///< [m/s^2]
constexpr double kTouchdownDepth = 0.01;     ///< aim below the ground [m]
constexpr double kTouchdownFeedback = 0.06;  ///< foot placement by velocity error [s]
constexpr double kLatchProgress = 0.6;       ///< fraction of the swing after which contact ends it
constexpr double kGroundFilter = 0.1;        ///< time constant [s]
constexpr double kHeldTolerance = 0.02;      ///< of the feet about the place held [m]
constexpr double kVelocityIntegralLimit = 0.25;  ///< [m/s]
constexpr double kYawIntegralLimit = 0.4;        ///< [rad/s]

double toward(double value, double goal, double step) {
  return value + std::clamp(goal - value, -step, step);
}

bool is_zero(const VelocityCommand& command) {
  return command.velocity.isZero(1e-6) && std::abs(command.yaw_rate) < 1e-6;
}

}  // namespace

struct GaitController::View {
  Eigen::Matrix3d R_world_base;
  double yaw = 0.0;
  Eigen::Matrix2d R_world_heading;
  Eigen::Vector3d position;  ///< of the base [m]
  Eigen::Vector3d com;       ///< [m]
  Eigen::Vector3d velocity;  ///< of the base [m/s]
  Eigen::Vector3d turning;   ///< angular velocity [rad/s]
  std::array<Eigen::Vector3d, kLegCount> feet;

  View(const RobotState& state, const BodyModel& body)
      : R_world_base(state.T_world_base.R()),
        yaw(yaw_of(state.T_world_base.rotation)),
        R_world_heading(Eigen::Rotation2Dd(yaw).toRotationMatrix()),
        position(state.T_world_base.translation),
        com(state.T_world_base * body.com_in_base),
        velocity(state.velocity),
        turning(R_world_base * state.angular_velocity) {
    for (int leg = 0; leg < kLegCount; ++leg) {
      feet[leg] = state.T_world_base * foot_in_base(leg, joints_of(state.q, leg), body.legs);
    }
  }

  Eigen::Vector2d mean_foot() const {
    return (feet[0] + feet[1] + feet[2] + feet[3]).head<2>() / kLegCount;
  }
};

GaitController::GaitController(const GaitConfig& config, const BodyModel& body, double timestep)
    : config_(config), body_(body), dt_(timestep), hold_feet_(config.hold) {
  stands_.fill(true);
}

/// Diagonal pairs trot half a period apart.
double GaitController::leg_phase(int leg) const {
  const double offset = leg == 0 || leg == 3 ? 0.0 : 0.5;
  return std::fmod(phase_ + offset, 1.0);
}

double GaitController::swing_progress(int leg) const {
  return (leg_phase(leg) - config_.duty_factor) / (1.0 - config_.duty_factor);
}

Eigen::Vector3d GaitController::desired_velocity(const View& now) const {
  const Eigen::Vector2d horizontal = now.R_world_heading * (target_.velocity + velocity_integral_);
  return {horizontal.x(), horizontal.y(), 0.0};
}

void GaitController::begin_standing(const View& now) {
  standing_ = true;
  target_ = {};
  velocity_integral_.setZero();
  yaw_rate_integral_ = 0.0;
  hold_position_ = now.mean_foot();
  hold_yaw_ = now.yaw;
  hold_feet_.begin(now.feet);
  stands_.fill(true);
  latched_.fill(false);
}

/// The place that is held follows feet that creep away as a whole, which they do on a slope.
void GaitController::follow_feet(const View& now) {
  const Eigen::Vector2d crept = now.mean_foot() - hold_position_;
  const double distance = crept.norm();
  if (distance > kHeldTolerance) hold_position_ += (1.0 - kHeldTolerance / distance) * crept;
}

/// Limits the rate of change of the command.
void GaitController::limit_command(const VelocityCommand& command, const View& now) {
  if (standing_) return;
  const Eigen::Vector2d change = command.velocity - target_.velocity;
  const double step = config_.acceleration * dt_;
  target_.velocity += change.norm() > step ? Eigen::Vector2d(change.normalized() * step) : change;
  target_.yaw_rate = toward(target_.yaw_rate, command.yaw_rate, config_.yaw_acceleration * dt_);
  integrate_errors(now);
}

void GaitController::integrate_errors(const View& now) {
  const Eigen::Vector2d v = now.R_world_heading.transpose() * now.velocity.head<2>();
  const double gain = config_.integral_gain * dt_;
  velocity_integral_ = (velocity_integral_ + gain * (target_.velocity - v))
                           .cwiseMax(-kVelocityIntegralLimit)
                           .cwiseMin(kVelocityIntegralLimit);
  yaw_rate_integral_ = std::clamp(yaw_rate_integral_ + gain * (target_.yaw_rate - now.turning.z()),
                                  -kYawIntegralLimit, kYawIntegralLimit);
}

void GaitController::advance_phase(const RobotState& state, const VelocityCommand& command,
                                   const View& now) {
  const bool zero = is_zero(command);
  if (standing_) {
    if (zero) return;
    standing_ = false;
    phase_ = 0.0;
    idle_time_ = 0.0;
    motion_ = 0.0;
  } else {
    phase_ = std::fmod(phase_ + dt_ / config_.period, 1.0);
    idle_time_ = zero ? idle_time_ + dt_ : 0.0;
    motion_ = toward(motion_, zero ? 0.0 : 1.0, dt_ / config_.period);
  }
  schedule_feet(state, now);
  const bool all_stand = std::all_of(stands_.begin(), stands_.end(), [](bool s) { return s; });
  const bool slow = now.velocity.head<2>().norm() < 0.12 && std::abs(now.turning.z()) < 0.3;
  if (zero && is_zero(target_) && all_stand && slow && idle_time_ > config_.period) {
    begin_standing(now);
  }
}

void GaitController::schedule_feet(const RobotState& state, const View& now) {
  for (int leg = 0; leg < kLegCount; ++leg) {
    const double progress = swing_progress(leg);
    if (progress < 0.0) {
      stands_[leg] = true;
      latched_[leg] = false;
      continue;
    }
    if (stands_[leg] && !latched_[leg]) liftoff_[leg] = now.feet[leg];
    const bool touches = state.foot_load[leg] > config_.contact_load;
    latched_[leg] = latched_[leg] || (progress > kLatchProgress && touches);
    stands_[leg] = latched_[leg];
  }
}

StanceProblem GaitController::stance_problem(const View& now) const {
  const Eigen::Vector3d up = now.R_world_base.col(2);
  Eigen::Vector3d linear = config_.velocity_gain * (desired_velocity(now) - now.velocity);
  linear.z() = config_.height_gain * (ground_ + config_.body_height - now.position.z()) -
               config_.height_damping * now.velocity.z() + kGravity;
  Eigen::Vector3d angular = config_.attitude_gain * up.cross(Eigen::Vector3d::UnitZ()) -
                            config_.attitude_damping * now.turning;
  angular.z() += config_.attitude_damping * (target_.yaw_rate + yaw_rate_integral_);
  if (!standing_) move_trunk(now, linear, angular);
  if (standing_) {
    linear.head<2>() += config_.standing_gain * (hold_position_ - now.position.head<2>());
    angular.z() += config_.standing_gain * wrap_angle(hold_yaw_ - now.yaw);
  }
  StanceProblem problem;
  problem.mass = body_.mass;
  problem.inertia = now.R_world_base * body_.inertia * now.R_world_base.transpose();
  problem.stands = stands_;
  for (int leg = 0; leg < kLegCount; ++leg) problem.lever[leg] = now.feet[leg] - now.com;
  problem.acceleration << linear, angular;
  return problem;
}

/// Adds what moves the trunk within the stride: feed-forward and the shift of the set points.
void GaitController::move_trunk(const View& now, Eigen::Vector3d& linear,
                                Eigen::Vector3d& angular) const {
  const TrunkReference move =
      motion_ * trunk_reference(config_.trunk, phase_, config_.duty_factor, config_.period);
  linear.z() += move.acceleration + config_.height_damping * move.velocity +
                config_.height_gain * move.height;
  angular +=
      yaw_rotation(now.yaw) * (move.angular_acceleration + config_.attitude_damping * move.rate +
                               config_.attitude_gain * move.tilt);
}

/// Target of the foot: under the predicted position of the hip, ahead by half a stance.
Eigen::Vector3d GaitController::touchdown(int leg, const View& now) const {
  const double time_left =
      (1.0 - swing_progress(leg)) * (1.0 - config_.duty_factor) * config_.period;
  const double stance_time = config_.duty_factor * config_.period;
  Eigen::Vector3d under_hip = hip_in_base(leg, body_.legs);
  under_hip.y() += side_of(leg) * config_.stance_width;
  const double yaw_then = now.yaw + now.turning.z() * time_left;
  const Eigen::Vector3d hip = yaw_rotation(yaw_then) * under_hip;
  const Eigen::Vector3d hip_velocity =
      now.velocity + Eigen::Vector3d(0.0, 0.0, now.turning.z()).cross(hip);
  const Eigen::Vector3d error = now.velocity - desired_velocity(now);
  Eigen::Vector3d foot = now.position + hip + now.velocity * time_left +
                         0.5 * stance_time * hip_velocity + kTouchdownFeedback * error;
  foot.z() = ground_ + body_.legs.foot_radius - kTouchdownDepth;
  return foot;
}

Eigen::Vector3d GaitController::swing_torques(int leg, const RobotState& state,
                                              const View& now) const {
  const double s = std::clamp(swing_progress(leg), 0.0, 1.0);
  const Swing swing = {.from = liftoff_[leg],
                       .to = touchdown(leg, now),
                       .apex = ground_ + body_.legs.foot_radius + config_.swing_height,
                       .time = (1.0 - config_.duty_factor) * config_.period};
  const SwingPoint goal = swing_point(config_.swing, swing, s);

  const Eigen::Matrix3d R = now.R_world_base.transpose();
  const Eigen::Vector3d in_base = R * (goal.position - now.position);
  const Eigen::Vector3d rate_in_base =
      R * (goal.velocity - now.velocity) - state.angular_velocity.cross(in_base);
  const Eigen::Vector3d q = joints_of(state.q, leg);
  const Eigen::Matrix3d J = foot_jacobian(leg, q, body_.legs);
  const Eigen::Matrix3d damped = J.transpose() * J + 1e-4 * Eigen::Matrix3d::Identity();
  const Eigen::Vector3d desired_rate = damped.inverse() * (J.transpose() * rate_in_base);
  return config_.swing_stiffness * (leg_angles(leg, in_base, body_.legs) - q) +
         config_.swing_damping * (desired_rate - joints_of(state.qd, leg));
}

JointVector GaitController::torques(const RobotState& state, const VelocityCommand& command) {
  const View now(state, body_);
  double foot_height = 0.0;
  for (int leg = 0; leg < kLegCount; ++leg) {
    if (stands_[leg]) foot_height += now.feet[leg].z() - body_.legs.foot_radius;
  }
  foot_height /= std::max<double>(1.0, std::count(stands_.begin(), stands_.end(), true));
  if (!started_) {
    ground_ = foot_height;
    begin_standing(now);
    started_ = true;
  }
  ground_ += dt_ / kGroundFilter * (foot_height - ground_);
  advance_phase(state, command, now);
  limit_command(command, now);

  if (standing_) follow_feet(now);
  auto forces = stance_forces(stance_problem(now), config_.forces);
  if (standing_) {
    const StanceHold::Offsets held = hold_feet_.forces(now.feet);
    for (int leg = 0; leg < kLegCount; ++leg) forces[leg].head<2>() += held.col(leg);
  }
  JointVector torques;
  for (int leg = 0; leg < kLegCount; ++leg) {
    const Eigen::Matrix3d J = foot_jacobian(leg, joints_of(state.q, leg), body_.legs);
    torques.segment<3>(3 * leg) =
        stands_[leg] ? Eigen::Vector3d(-J.transpose() * now.R_world_base.transpose() * forces[leg])
                     : swing_torques(leg, state, now);
  }
  return torques;
}

}  // namespace aims
