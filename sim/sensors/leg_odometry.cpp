// SPDX-License-Identifier: BSD-3-Clause
#include "sim/sensors/leg_odometry.hpp"

#include <cmath>

#include "core/leg_kinematics.hpp"
#include "sim/sensors/sampling.hpp"

namespace aims {
namespace {

constexpr double kLevellingRate = 1.0;  ///< of roll and pitch towards gravity [1/s]
constexpr double kMovingSpeed = 0.1;    ///< below it the robot stands and slip adds no error [m/s]

JointVector joints_in(const std::array<double, kJointCount>& values) {
  return Eigen::Map<const JointVector>(values.data());
}

LegRunErrors draw_errors(const LegOdometryConfig& config, std::uint64_t robot_seed) {
  RandomStream run(robot_seed, "leg.run");
  LegRunErrors errors;
  errors.velocity_scale =
      config.velocity_scale * (1.0 + config.velocity_scale_error * run.normal());
  errors.gyro_scale = 1.0 + config.gyro_scale_error * run.normal();
  errors.gyro_bias = config.gyro_bias * run.normal3();
  for (double& offset : errors.angle_offset) offset = config.joint_angle_offset * run.normal();
  return errors;
}

}  // namespace

LegOdometry::LegOdometry(const LegOdometryConfig& config, const LegGeometry& legs,
                         Duration timestep, RunSeeds seeds)
    : config_(config),
      legs_(legs),
      steps_(*steps_per_sample("leg_odometry.rate", config.rate, timestep)),
      interval_(1.0 / config.rate),
      errors_(draw_errors(config, seeds.robot)),
      compliance_(config, legs, timestep),
      encoders_(config, timestep, errors_.angle_offset, seeds.run),
      contacts_(config, timestep, seeds),
      gyro_(seeds.run, "leg.gyro"),
      slip_(seeds.run, "leg.slip") {}

/// The odometry frame is the base's frame at the start, made level.
void LegOdometry::begin(const RobotState& truth) {
  last_rotation_ = truth.T_world_base.rotation;
  T_odom_base_.rotation = yaw_rotation(-yaw_of(last_rotation_)) * last_rotation_;
  started_ = true;
  contacts_.begin(truth.foot_load);
}

/// The gyro's mean rate over the interval; the attitude it integrates to, levelled by gravity.
void LegOdometry::measure_rotation(const RobotState& truth, LegOdometrySample& sample) {
  const Eigen::Quaterniond& now = truth.T_world_base.rotation;
  const Eigen::Vector3d true_rate = so3_log(last_rotation_.conjugate() * now) / interval_;
  const double noise = config_.gyro_noise_density / std::sqrt(interval_);
  sample.angular_velocity =
      errors_.gyro_scale * true_rate + errors_.gyro_bias + noise * gyro_.normal3();
  last_rotation_ = now;
  T_odom_base_.rotation =
      (T_odom_base_.rotation * so3_exp(sample.angular_velocity * interval_)).normalized();
  const Eigen::Vector3d up_measured = now.conjugate() * Eigen::Vector3d::UnitZ();
  const Eigen::Vector3d up_estimated = T_odom_base_.rotation.conjugate() * Eigen::Vector3d::UnitZ();
  const Eigen::Vector3d correction = kLevellingRate * interval_ * up_measured.cross(up_estimated);
  T_odom_base_.rotation = (T_odom_base_.rotation * so3_exp(correction)).normalized();
}

/// Velocity of the base in base axes if that foot stands.
Eigen::Vector3d LegOdometry::foot_velocity(int leg, const LegOdometrySample& sample) const {
  const LegMotion motion{joints_of(joints_in(sample.joint_position), leg),
                         joints_of(joints_in(sample.joint_velocity), leg), sample.angular_velocity};
  if (config_.foot_model == FootModel::kPoint) {
    return velocity_from_foot(leg, motion, legs_);
  }
  const Eigen::Vector3d up = T_odom_base_.rotation.conjugate() * Eigen::Vector3d::UnitZ();
  return velocity_from_rolling_foot(leg, motion, up, legs_);
}

/// Mean over the standing feet; without any, the last velocity.
Eigen::Vector3d LegOdometry::body_velocity(const LegOdometrySample& sample) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  int feet = 0;
  for (int leg = 0; leg < kLegCount; ++leg) {
    if (!sample.contact[leg]) continue;
    sum += foot_velocity(leg, sample);
    ++feet;
  }
  if (feet > 0) velocity_ = sum / feet;
  return errors_.velocity_scale * velocity_ + slip_error(velocity_);
}

/// Slip: the feet move faster than the body and the measured speed is too high.
Eigen::Vector3d LegOdometry::slip_error(const Eigen::Vector3d& velocity) {
  const bool begins = slip_.chance(config_.slip_rate * interval_);
  const double size = std::abs(slip_.normal()) * config_.slip_speed;
  if (begins && slip_left_ <= 0.0) {
    slip_left_ = config_.slip_duration;
    slip_size_ = size;
  }
  if (slip_left_ <= 0.0) return Eigen::Vector3d::Zero();
  slip_left_ -= interval_;
  const Eigen::Vector3d along(velocity.x(), velocity.y(), 0.0);
  if (along.norm() < kMovingSpeed) return Eigen::Vector3d::Zero();
  return slip_size_ * along.normalized();
}

std::optional<LegOdometrySample> LegOdometry::sample(const RobotState& truth) {
  encoders_.update(compliance_.update(truth));
  if (!started_) {
    begin(truth);
    return std::nullopt;
  }
  contacts_.update(truth.foot_load);
  if (++count_ < steps_) return std::nullopt;
  count_ = 0;
  LegOdometrySample sample;
  sample.stamp = truth.stamp;
  encoders_.read(sample);
  sample.contact = contacts_.detect(interval_);
  sample.contact_force = contacts_.measured();
  measure_rotation(truth, sample);
  sample.linear_velocity = body_velocity(sample);
  T_odom_base_.translation += T_odom_base_.rotation * sample.linear_velocity * interval_;
  sample.T_odom_base = T_odom_base_;
  return sample;
}

}  // namespace aims
