// SPDX-License-Identifier: BSD-3-Clause
#include "estimator/aims/directional_config.hpp"

namespace aims {
namespace {

template <class Config>
void describe_switch(Fields& f, Config& c, std::string meaning) {
  f.flag("enabled", c.enabled, {"", any(), std::move(meaning)});
}

}  // namespace

DirectionalConfig without_parts() {
  DirectionalConfig none;
  none.spurious.enabled = false;
  none.leg_states.scale = false;
  none.leg_states.bias = false;
  none.leg_states.hold = false;
  none.leg_evidence.enabled = false;
  none.start.enabled = false;
  none.standstill.enabled = false;
  none.floor.enabled = false;
  none.robust.enabled = false;
  none.map_memory.enabled = true;
  return none;
}

void describe(Fields& f, SpuriousConfig& c) {
  describe_switch(f, c, "subtract the information that noisy normals give by chance");
  f.number("chance_share", c.chance_share,
           {"-", positive(),
            "share of the chance information implied by plane fits that is "
            "found between walls without features"});
  f.number("significant", c.significant,
           {"-", at_least(1), "ratio to chance at which information is as likely real as not"});
  f.number("start_excess", c.start_excess,
           {"-", at_least(0), "share more than that, asked for at the start"});
  f.number("start_way", c.start_way, {"m", positive(), "way over which that falls off"});
  f.number("trusting_way", c.trusting_way,
           {"m", at_least(0), "way from the start over which information need not be significant"});
  f.number("spread", c.spread,
           {"-", positive(), "uncertainty of what chance gives, of its logarithm"});
  f.number("stretch", c.stretch, {"m", positive(), "way over which information is judged"});
  f.number("amplification", c.amplification,
           {"-", at_least(1), "most that a step is lengthened for chance in its information"});
  f.number("axis_tolerance", c.axis_tolerance,
           {"rad", at_least(0), "within which the axes are kept"});
}

void describe(Fields& f, LegStatesConfig& c) {
  f.flag("scale", c.scale, {"", any(), "estimate what share of the speed the legs misreport"});
  f.flag("bias", c.bias, {"", any(), "estimate a constant error of their speed"});
  f.flag("hold", c.hold, {"", any(), "learn both only where the LiDAR is trusted"});
  f.number("scale_sigma", c.scale_sigma, {"-", positive(), "scale before anything is known"});
  f.number("scale_walk", c.scale_walk, {"1/sqrt(s)", at_least(0), "random walk of the scale"});
  f.number("bias_sigma", c.bias_sigma, {"m/s", positive(), "bias before anything is known"});
  f.number("bias_walk", c.bias_walk, {"m/s/sqrt(s)", at_least(0), "random walk of the bias"});
  f.number("trusted", c.trusted,
           {"-", in_range(0.0, 1.0),
            "weight of the weakest axis, smoothed over a second, "
            "above which the LiDAR teaches the legs"});
}

void describe(Fields& f, LegEvidenceConfig& c) {
  describe_switch(f, c, "leg noise from stance, spread among stance legs, turning and packet age");
  f.vector("velocity_sigma", c.velocity_sigma,
           {"m/s", positive(), "error of one sample in a firm stance, along the base's axes"});
  f.number("correlation_time", c.correlation_time,
           {"s", in_range(0.0, 10.0), "for how long that error lasts"});
  f.number("nominal_spread", c.nominal_spread,
           {"m/s", at_least(0), "among the velocities told by feet that stand firm"});
  f.number("one_foot_sigma", c.one_foot_sigma,
           {"m/s", at_least(0), "added when a single foot stands"});
  f.number("no_foot_sigma", c.no_foot_sigma,
           {"m/s", at_least(0), "added when no foot stands; bounds what a gap adds"});
  f.number("turning_arm", c.turning_arm, {"m", at_least(0), "added per rate of yaw"});
  f.number("gap_growth", c.gap_growth, {"m/s^2", at_least(0), "added per time without packets"});
  f.number("gate", c.gate,
           {"-", positive(), "chi-square above which the noise grows", "3 dof, 99.9 %"});
  f.number("drop", c.drop,
           {"-", at_least(1), "growth of the variance beyond which a sample is dropped"});
  f.number("longest_slip", c.longest_slip,
           {"s", at_least(0), "an innovation that lasts longer is believed"});
}

void describe(Fields& f, StartConfig& c) {
  describe_switch(f, c, "start from the longest quiet stretch of a stand that is disturbed");
  f.number("rate", c.rate, {"rad/s", positive(), "deviation from its mean that ends a stretch"});
  f.number("force", c.force, {"m/s^2", positive(), "deviation from its mean that ends a stretch"});
  f.number("shortest", c.shortest, {"s", at_least(0.05), "a shorter stretch tells no tilt"});
  f.number("shortest_for_rate", c.shortest_for_rate,
           {"s", at_least(0.05), "a shorter stretch tells no gyro bias"});
}

void describe(Fields& f, StandstillConfig& c) {
  describe_switch(f, c, "zero-velocity update while the robot stands still");
  f.number("window", c.window,
           {"s", in_range(0.05, 0.9), "rest of IMU and legs; one measurement per window"});
  f.number("rate", c.rate, {"rad/s", positive(), "largest rate of a body at rest"});
  f.number("force", c.force,
           {"m/s^2", positive(), "largest deviation of the force at rest from its mean"});
  f.number("leg_speed", c.leg_speed, {"m/s", positive(), "largest speed of legs at rest"});
  f.number("joint_rate", c.joint_rate,
           {"rad/s", positive(), "largest root mean square rate of joints at rest"});
  f.number("leg_smoothing", c.leg_smoothing, {"s", positive(), "time constant of both"});
  f.number("hysteresis", c.hysteresis,
           {"-", at_least(1), "factor by which a standing robot may exceed the limits"});
  f.number("sigma_velocity", c.sigma_velocity, {"m/s", positive(), "of a body at rest"});
  f.number("sigma_rate", c.sigma_rate, {"rad/s", positive(), "of the mean rate of a body at rest"});
}

void describe(Fields& f, FloorConfig& c) {
  describe_switch(f, c, "hold height and tilt by a level floor");
  f.number("radius", c.radius, {"m", positive(), "where the floor is sought"});
  f.number("min_height", c.min_height, {"m", positive(), "least height above the floor"});
  f.number("max_height", c.max_height, {"m", positive(), "greatest height above the floor"});
  f.number("max_slope", c.max_slope,
           {"-", positive(), "of the floor in body axes, where it is sought"});
  f.number("band", c.band, {"m", positive(), "points this close to the floor are on it"});
  f.integer("min_points", c.min_points, {"-", at_least(3), "points that make a floor"});
  f.number("min_spread", c.min_spread,
           {"m", positive(), "least deviation of the floor's points along any direction"});
  f.number("max_residual", c.max_residual,
           {"m", positive(), "root mean square distance of the floor's points from it"});
  f.number("bend", c.bend, {"m", positive(), "a part of the floor further off is not level"});
  f.number("tilt", c.tilt, {"rad", positive(), "a floor less tilted is level"});
  f.number("max_tilt", c.max_tilt,
           {"rad", positive(), "a floor more tilted is not level, however unsure the attitude"});
  f.number("step", c.step, {"m", positive(), "change of height that makes another floor"});
  f.number("settle", c.settle,
           {"m", at_least(0), "way on level floor before it is believed again"});
  f.number("spacing", c.spacing, {"m", at_least(0), "way between measurements of the floor"});
  f.number("correlation_length", c.correlation_length,
           {"m", positive(), "over it the floor's unevenness repeats itself"});
  f.number("sigma_tilt", c.sigma_tilt, {"rad", positive(), "unevenness of a level floor"});
  f.number("sigma_height", c.sigma_height, {"m", positive(), "unevenness of a level floor"});
}

void describe(Fields& f, RobustConfig& c) {
  describe_switch(f, c, "weigh each point by its residual");
  f.number("scale", c.scale,
           {"-", positive(), "deviations of a scan's residuals at which a weight is a half"});
  f.number("least", c.least, {"m", positive(), "deviation that is taken at least"});
}

void describe(Fields& f, MapMemoryConfig& c) {
  describe_switch(f, c, "use the map of the way out again on the way back");
  f.integer("forget_after", c.forget_after,
            {"-", at_least(1), "else voxels are forgotten when unseen for so many scans"});
}

void describe(Fields& f, DirectionalConfig& c) {
  f.group("spurious", c.spurious);
  f.group("leg_states", c.leg_states);
  f.group("leg_evidence", c.leg_evidence);
  f.group("start", c.start);
  f.group("standstill", c.standstill);
  f.group("floor", c.floor);
  f.group("robust", c.robust);
  f.group("map_memory", c.map_memory);
}

}  // namespace aims
