// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <optional>

#include "core/config.hpp"
#include "core/error.hpp"
#include "core/leg_kinematics.hpp"
#include "core/measurements.hpp"
#include "core/random.hpp"
#include "sim/robot/world.hpp"

namespace aims {

/// The robot's own odometry: encoders, contact detection, its own gyro.
struct LegOdometryConfig {
  double rate = 200.0;  ///< samples per second [Hz]
  FootModel foot_model = FootModel::kPoint;
  double joint_angle_noise = 5e-4;     ///< per sample [rad]
  double joint_angle_offset = 5e-3;    ///< standard deviation of the offset, per run [rad]
  double joint_rate_noise = 0.05;      ///< per sample [rad/s]
  double contact_on = 20.0;            ///< foot load above which contact is detected [N]
  double contact_off = 10.0;           ///< foot load below which contact is lost [N]
  double load_noise = 2.0;             ///< of the measured load, per sample [N]
  double contact_debounce = 0.010;     ///< from touchdown until contact is reported [s]
  double gyro_noise_density = 2e-4;    ///< [rad/s/sqrt(Hz)]
  double gyro_bias = 1.7e-3;           ///< standard deviation per axis, per run [rad/s]
  double gyro_scale_error = 5e-3;      ///< standard deviation per run [-]
  double velocity_scale = 1.0;         ///< reported over measured velocity, in every run [-]
  double velocity_scale_error = 0.03;  ///< standard deviation of the speed's scale, per run [-]
  double slip_rate = 0.3;              ///< injected slip bursts per second [Hz]
  double slip_speed = 0.15;            ///< standard deviation of a burst's speed error [m/s]
  double slip_duration = 0.2;          ///< of a burst [s]
};
void describe(Fields& f, LegOdometryConfig& c);

/// Error when the rate does not divide the physics rate, or the contact thresholds cross.
Result<void> validate(const LegOdometryConfig& config, Duration timestep);

/// Simulates the robot's leg odometry from its true state. Heading integrates the gyro alone; roll
/// and pitch are corrected by gravity, as by an attitude filter.
class LegOdometry {
 public:
  /// `config` is valid. Random streams: "leg.run", "leg.encoder", "leg.contact", "leg.gyro",
  /// "leg.slip".
  LegOdometry(const LegOdometryConfig& config, Duration timestep, std::uint64_t run_seed);

  /// Processes the true state before the first and after each physics step; returns a sample at
  /// the end of each interval.
  std::optional<LegOdometrySample> sample(const RobotState& truth);

 private:
  void begin(const RobotState& truth);
  void measure_joints(const RobotState& truth, LegOdometrySample& sample);
  void detect_contacts(const RobotState& truth, LegOdometrySample& sample);
  void measure_rotation(const RobotState& truth, LegOdometrySample& sample);
  Eigen::Vector3d foot_velocity(int leg, const LegOdometrySample& sample) const;
  Eigen::Vector3d body_velocity(const LegOdometrySample& sample);
  Eigen::Vector3d slip_error(const Eigen::Vector3d& velocity);

  LegOdometryConfig config_;
  int steps_;
  double interval_;  ///< [s]
  RandomStream encoder_, contact_, gyro_, slip_;
  JointVector angle_offset_;
  Eigen::Vector3d gyro_bias_;
  double gyro_scale_ = 1.0;
  double velocity_scale_ = 1.0;

  bool started_ = false;
  int count_ = 0;
  Eigen::Quaterniond last_rotation_ = Eigen::Quaterniond::Identity();  ///< true, a sample ago
  Pose T_odom_base_;
  Eigen::Vector3d velocity_ = Eigen::Vector3d::Zero();  ///< last estimate, base axes [m/s]
  std::array<bool, kLegCount> loaded_{};
  std::array<double, kLegCount> loaded_time_{};  ///< since touchdown [s]
  double slip_left_ = 0.0;                       ///< of the present burst [s]
  double slip_size_ = 0.0;                       ///< of the present burst [m/s]
};

}  // namespace aims
