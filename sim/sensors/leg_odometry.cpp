// SPDX-License-Identifier: BSD-3-Clause
#include "sim/sensors/leg_odometry.hpp"

#include <cmath>

#include "core/leg_kinematics.hpp"
#include "sim/robot/robot_geometry.hpp"
#include "sim/sensors/sampling.hpp"

namespace aims {
namespace {

constexpr double kLevellingRate = 1.0;  ///< of roll and pitch towards gravity [1/s]
constexpr double kMovingSpeed = 0.1;    ///< below it the robot stands and slip adds no error [m/s]

JointVector joints_in(const std::array<double, kJointCount>& values) {
  return Eigen::Map<const JointVector>(values.data());
}

}  // namespace

Result<void> validate(const LegOdometryConfig& config, Duration timestep) {
  const auto steps = steps_per_sample("leg_odometry.rate", config.rate, timestep);
  if (!steps) return tl::unexpected(steps.error());
  if (config.contact_off > config.contact_on) {
    return failure("leg_odometry.contact_off: expected at most leg_odometry.contact_on");
  }
  return {};
}

LegOdometry::LegOdometry(const LegOdometryConfig& config, Duration timestep, std::uint64_t run_seed)
    : config_(config),
      steps_(*steps_per_sample("leg_odometry.rate", config.rate, timestep)),
      interval_(1.0 / config.rate),
      encoder_(run_seed, "leg.encoder"),
      contact_(run_seed, "leg.contact"),
      gyro_(run_seed, "leg.gyro"),
      slip_(run_seed, "leg.slip") {
  RandomStream run(run_seed, "leg.run");
  velocity_scale_ = config_.velocity_scale * (1.0 + config_.velocity_scale_error * run.normal());
  gyro_scale_ = 1.0 + config_.gyro_scale_error * run.normal();
  gyro_bias_ = config_.gyro_bias * run.normal3();
  for (double& offset : angle_offset_) offset = config_.joint_angle_offset * run.normal();
}

/// The odometry frame is the base's frame at the start, made level.
void LegOdometry::begin(const RobotState& truth) {
  last_rotation_ = truth.T_world_base.rotation;
  T_odom_base_.rotation = yaw_rotation(-yaw_of(last_rotation_)) * last_rotation_;
  started_ = true;
  for (int leg = 0; leg < kLegCount; ++leg) {
    loaded_[leg] = truth.foot_load[leg] > config_.contact_on;
    loaded_time_[leg] = config_.contact_debounce;
  }
}

void LegOdometry::measure_joints(const RobotState& truth, LegOdometrySample& sample) {
  for (int i = 0; i < kJointCount; ++i) {
    sample.joint_position[i] =
        truth.q[i] + angle_offset_[i] + config_.joint_angle_noise * encoder_.normal();
    sample.joint_velocity[i] = truth.qd[i] + config_.joint_rate_noise * encoder_.normal();
  }
}

void LegOdometry::detect_contacts(const RobotState& truth, LegOdometrySample& sample) {
  for (int leg = 0; leg < kLegCount; ++leg) {
    const double load = truth.foot_load[leg] + config_.load_noise * contact_.normal();
    loaded_[leg] = load > (loaded_[leg] ? config_.contact_off : config_.contact_on);
    loaded_time_[leg] = loaded_[leg] ? loaded_time_[leg] + interval_ : 0.0;
    sample.contact[leg] = loaded_[leg] && loaded_time_[leg] > config_.contact_debounce;
  }
}

/// The gyro's mean rate over the interval; the attitude it integrates to, levelled by gravity.
void LegOdometry::measure_rotation(const RobotState& truth, LegOdometrySample& sample) {
  const Eigen::Quaterniond& now = truth.T_world_base.rotation;
  const Eigen::Vector3d true_rate = so3_log(last_rotation_.conjugate() * now) / interval_;
  const double noise = config_.gyro_noise_density / std::sqrt(interval_);
  sample.angular_velocity = gyro_scale_ * true_rate + gyro_bias_ + noise * gyro_.normal3();
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
    return velocity_from_foot(leg, motion, kRobotGeometry);
  }
  const Eigen::Vector3d up = T_odom_base_.rotation.conjugate() * Eigen::Vector3d::UnitZ();
  return velocity_from_rolling_foot(leg, motion, up, kRobotGeometry);
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
  return velocity_scale_ * velocity_ + slip_error(velocity_);
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
  if (!started_) {
    begin(truth);
    return std::nullopt;
  }
  if (++count_ < steps_) return std::nullopt;
  count_ = 0;
  LegOdometrySample sample;
  sample.stamp = truth.stamp;
  measure_joints(truth, sample);
  detect_contacts(truth, sample);
  measure_rotation(truth, sample);
  sample.linear_velocity = body_velocity(sample);
  T_odom_base_.translation += T_odom_base_.rotation * sample.linear_velocity * interval_;
  sample.T_odom_base = T_odom_base_;
  return sample;
}

namespace {

void describe_gyro_and_velocity(Fields& f, LegOdometryConfig& c) {
  f.number("gyro_noise_density", c.gyro_noise_density,
           {.unit = "rad/s/sqrt(Hz)",
            .range = up_to(1e3),
            .meaning = "Noise density of the gyro of the leg odometry."});
  f.number("gyro_bias", c.gyro_bias,
           {.unit = "rad/s",
            .range = up_to(1e4),
            .meaning = "Standard deviation per axis of the bias of that gyro, constant in a run."});
  f.number("gyro_scale_error", c.gyro_scale_error,
           {.unit = "-",
            .range = in_range(0.0, 0.2),
            .meaning = "Standard deviation of the scale error of that gyro, constant in a run."});
  f.number(
      "velocity_scale", c.velocity_scale,
      {.unit = "-",
       .range = in_range(0.2, 5.0),
       .meaning = "Ratio of reported to measured velocity in every run: a calibration error."});
  f.number("velocity_scale_error", c.velocity_scale_error,
           {.unit = "-",
            .range = in_range(0.0, 0.5),
            .meaning = "Standard deviation of the velocity scale error, constant in a run."});
  f.number("slip_rate", c.slip_rate,
           {.unit = "Hz", .range = up_to(1e3), .meaning = "Injected slip bursts per second."});
  f.number("slip_speed", c.slip_speed,
           {.unit = "m/s",
            .range = up_to(100.0),
            .meaning = "Standard deviation of the speed error during a burst."});
  f.number("slip_duration", c.slip_duration,
           {.unit = "s", .range = up_to(1e4), .meaning = "Duration of a burst."});
}

}  // namespace

void describe(Fields& f, LegOdometryConfig& c) {
  f.number("rate", c.rate,
           {.unit = "Hz",
            .range = in_range(1.0, 2000.0),
            .meaning = "Samples per second.",
            .source = "paper, III-A"});
  f.choice("foot_model", c.foot_model,
           {{"point", FootModel::kPoint}, {"rolling", FootModel::kRolling}},
           {.unit = "-",
            .meaning = "Foot model of the robot's own kinematics; the true feet are spheres."});
  f.number("joint_angle_noise", c.joint_angle_noise,
           {.unit = "rad",
            .range = up_to(10.0),
            .meaning = "Standard deviation of a joint angle, per sample."});
  f.number("joint_angle_offset", c.joint_angle_offset,
           {.unit = "rad",
            .range = up_to(10.0),
            .meaning = "Standard deviation of the offset of a joint angle, constant in a run."});
  f.number("joint_rate_noise", c.joint_rate_noise,
           {.unit = "rad/s",
            .range = up_to(1e3),
            .meaning = "Standard deviation of a joint rate, per sample."});
  f.number(
      "contact_on", c.contact_on,
      {.unit = "N", .range = up_to(1e5), .meaning = "Foot load above which contact is detected."});
  f.number("contact_off", c.contact_off,
           {.unit = "N", .range = up_to(1e5), .meaning = "Foot load below which contact is lost."});
  f.number("load_noise", c.load_noise,
           {.unit = "N",
            .range = up_to(1e5),
            .meaning = "Standard deviation of the measured foot load, per sample."});
  f.number("contact_debounce", c.contact_debounce,
           {.unit = "s",
            .range = up_to(10.0),
            .meaning = "Time from touchdown until contact is reported."});
  describe_gyro_and_velocity(f, c);
}

}  // namespace aims
