// SPDX-License-Identifier: BSD-3-Clause
#include "sim/sensors/leg_odometry_config.hpp"

#include "sim/sensors/sampling.hpp"

namespace aims {

Result<void> validate(const LegOdometryConfig& config, Duration timestep) {
  const auto steps = steps_per_sample("leg_odometry.rate", config.rate, timestep);
  if (!steps) return tl::unexpected(steps.error());
  if (config.contact_off > config.contact_on) {
    return failure("leg_odometry.contact_off: expected at most leg_odometry.contact_on");
  }
  return {};
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

void describe_legs(Fields& f, LegOdometryConfig& c) {
  f.number("link_length_error", c.link_length_error,
           {.unit = "-",
            .range = in_range(0.0, 0.05),
            .meaning = "Standard deviation of the relative error of the lengths of thighs and "
                       "calves that the kinematics assume, constant in a run."});
  f.number("foot_radius_difference", c.foot_radius_difference,
           {.unit = "m",
            .range = within(0.005),
            .meaning = "True radius of the feet less the one that the kinematics assume."});
  f.number("joint_stiffness", c.joint_stiffness,
           {.unit = "N m/rad",
            .range = up_to(1e6),
            .meaning = "Stiffness of transmission and structure between encoder and link; 0 for "
                       "rigid."});
  f.number("foot_stiffness", c.foot_stiffness,
           {.unit = "N/m",
            .range = up_to(1e8),
            .meaning = "Stiffness of the rubber foot in every direction; 0 for rigid."});
  f.number("compliance_time", c.compliance_time,
           {.unit = "s",
            .range = in_range(0.001, 1.0),
            .meaning = "Time constant with which the deflection of a leg follows its load."});
}

void describe_encoders(Fields& f, LegOdometryConfig& c) {
  f.number("joint_angle_noise", c.joint_angle_noise,
           {.unit = "rad",
            .range = up_to(10.0),
            .meaning = "Standard deviation of a joint angle, per sample."});
  f.number("joint_angle_offset", c.joint_angle_offset,
           {.unit = "rad",
            .range = up_to(10.0),
            .meaning = "Standard deviation of the offset of a joint angle, constant in a run."});
  f.number("joint_angle_resolution", c.joint_angle_resolution,
           {.unit = "rad",
            .range = up_to(1.0),
            .meaning = "Smallest step of a joint angle; 0 for none."});
  f.number("joint_rate_noise", c.joint_rate_noise,
           {.unit = "rad/s",
            .range = up_to(1e3),
            .meaning = "Standard deviation of a joint rate, per sample."});
  f.number("joint_rate_window", c.joint_rate_window,
           {.unit = "s",
            .range = in_range(0.0, 0.1),
            .meaning = "Time over which two angles are differenced to a joint rate; 0 for the "
                       "true rate."});
  f.number("encoder_delay", c.encoder_delay,
           {.unit = "s",
            .range = in_range(0.0, 0.1),
            .meaning = "Age of joint angles and rates at the stamp of their sample."});
}

void describe_contacts(Fields& f, LegOdometryConfig& c) {
  f.number(
      "contact_on", c.contact_on,
      {.unit = "N", .range = up_to(1e5), .meaning = "Foot load above which contact is detected."});
  f.number("contact_off", c.contact_off,
           {.unit = "N", .range = up_to(1e5), .meaning = "Foot load below which contact is lost."});
  f.number("load_noise", c.load_noise,
           {.unit = "N",
            .range = up_to(1e5),
            .meaning = "Standard deviation of the measured foot load, per sample."});
  f.number("load_offset", c.load_offset,
           {.unit = "N",
            .range = up_to(1e5),
            .meaning = "Standard deviation of the offset of a foot's force sensor, constant in a "
                       "run."});
  f.number("load_scale_error", c.load_scale_error,
           {.unit = "-",
            .range = in_range(0.0, 1.0),
            .meaning = "Standard deviation of the scale error of a foot's force sensor, constant "
                       "in a run."});
  f.number("load_zero", c.load_zero,
           {.unit = "N",
            .range = up_to(1e5),
            .meaning = "Largest reading of an unloaded foot; each has its own, constant in a run. "
                       "The robot's own detection of contact subtracts it."});
  f.number("load_rise_time", c.load_rise_time,
           {.unit = "s",
            .range = in_range(0.0, 1.0),
            .meaning = "Time constant with which a foot's force sensor follows a rising load."});
  f.number("load_hold", c.load_hold,
           {.unit = "s",
            .range = in_range(0.0, 0.2),
            .meaning = "Time for which a foot's force sensor keeps the largest load."});
  f.number("load_fall_time", c.load_fall_time,
           {.unit = "s",
            .range = in_range(0.0, 1.0),
            .meaning = "Time constant with which it follows a falling load after that."});
  f.number("load_latency", c.load_latency,
           {.unit = "s",
            .range = in_range(0.0, 0.2),
            .meaning = "Time by which the load of a foot is late."});
  f.number("contact_debounce", c.contact_debounce,
           {.unit = "s",
            .range = up_to(10.0),
            .meaning = "Time from touchdown until contact is reported."});
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
  describe_legs(f, c);
  describe_encoders(f, c);
  describe_contacts(f, c);
  describe_gyro_and_velocity(f, c);
}

}  // namespace aims
