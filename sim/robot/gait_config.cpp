// SPDX-License-Identifier: BSD-3-Clause
#include "sim/robot/gait.hpp"

namespace aims {
namespace {

void describe_stride(Fields& f, GaitConfig& c) {
  f.number("period", c.period,
           {.unit = "s",
            .range = in_range(0.2, 1.0),
            .meaning = "Period of a stride; a multiple of 20 ms aliases into a 50 Hz IMU."});
  f.number("duty_factor", c.duty_factor,
           {.unit = "-",
            .range = in_range(0.5, 0.9),
            .meaning = "Fraction of the stride that a foot is on the ground."});
  f.number("body_height", c.body_height,
           {.unit = "m",
            .range = in_range(0.2, 0.8),
            .meaning = "Height of the trunk above the ground."});
  f.number("swing_height", c.swing_height,
           {.unit = "m",
            .range = in_range(0.02, 0.15),
            .meaning = "Height of a foot above the ground in mid-swing."});
  f.number("stance_width", c.stance_width,
           {.unit = "m",
            .range = in_range(0.0, 0.3),
            .meaning = "Lateral distance of a standing foot from its hip."});
}

void describe_feedback(Fields& f, GaitConfig& c) {
  f.number(
      "velocity_gain", c.velocity_gain,
      {.unit = "1/s", .range = up_to(1e5), .meaning = "Gain of the horizontal velocity feedback."});
  f.number("height_gain", c.height_gain,
           {.unit = "1/s^2", .range = up_to(1e6), .meaning = "Gain of the height feedback."});
  f.number(
      "height_damping", c.height_damping,
      {.unit = "1/s", .range = up_to(1e5), .meaning = "Gain of the vertical velocity feedback."});
  f.number(
      "attitude_gain", c.attitude_gain,
      {.unit = "1/s^2", .range = up_to(1e6), .meaning = "Gain of the roll and pitch feedback."});
  f.number("attitude_damping", c.attitude_damping,
           {.unit = "1/s", .range = up_to(1e5), .meaning = "Gain of the angular rate feedback."});
  f.number("standing_gain", c.standing_gain,
           {.unit = "1/s^2",
            .range = up_to(1e6),
            .meaning = "Gain of the position and heading feedback while standing."});
  f.number("integral_gain", c.integral_gain,
           {.unit = "1/s",
            .range = up_to(1e5),
            .meaning = "Gain of the integral feedback of velocity and yaw rate."});
}

void describe_commands(Fields& f, GaitConfig& c) {
  f.number("acceleration", c.acceleration,
           {.unit = "m/s^2",
            .range = positive_up_to(1e5),
            .meaning = "Largest rate of change of the velocity command."});
  f.number("yaw_acceleration", c.yaw_acceleration,
           {.unit = "rad/s^2",
            .range = positive_up_to(1e5),
            .meaning = "Largest rate of change of the yaw-rate command."});
}

void describe_swinging_leg(Fields& f, GaitConfig& c) {
  f.number("swing_stiffness", c.swing_stiffness,
           {.unit = "N m/rad",
            .range = positive_up_to(1e5),
            .meaning = "Stiffness of the joints of a leg that swings."});
  f.number("swing_damping", c.swing_damping,
           {.unit = "N m s/rad",
            .range = up_to(1e4),
            .meaning = "Damping of the joints of a leg that swings."});
  f.number("contact_load", c.contact_load,
           {.unit = "N",
            .range = positive_up_to(1e4),
            .meaning = "Load of a swinging foot above which it has touched down."});
}

}  // namespace

void describe(Fields& f, GaitConfig& c) {
  describe_stride(f, c);
  describe_feedback(f, c);
  describe_commands(f, c);
  describe_swinging_leg(f, c);
  f.group("swing", c.swing);
  f.group("hold", c.hold);
  f.group("trunk", c.trunk);
  f.group("forces", c.forces);
}

}  // namespace aims
