// SPDX-License-Identifier: BSD-3-Clause
#include "estimator/directional_config.hpp"

namespace aims {
namespace {

Spec spec(std::string unit, Range range, std::string meaning, std::string source = "") {
  return {std::move(unit), range, std::move(meaning), std::move(source)};
}

template <class Config>
void describe_switch(Fields& f, Config& c, std::string meaning) {
  f.flag("enabled", c.enabled, spec("", any(), std::move(meaning)));
}

}  // namespace

void describe(Fields& f, SpuriousConfig& c) {
  describe_switch(f, c, "subtract the information that noisy normals give by chance");
  f.number("significant", c.significant,
           spec("-", at_least(1), "ratio to chance at which information is as likely real as not"));
  f.number("spread", c.spread,
           spec("-", positive(), "uncertainty of what chance gives, of its logarithm"));
}

void describe(Fields& f, LegStatesConfig& c) {
  f.flag("scale", c.scale, spec("", any(), "estimate what share of the speed the legs misreport"));
  f.flag("bias", c.bias, spec("", any(), "estimate a constant error of their speed"));
  f.flag("hold", c.hold, spec("", any(), "learn both only where the LiDAR is trusted"));
  f.number("scale_sigma", c.scale_sigma, spec("-", positive(), "scale before anything is known"));
  f.number("scale_walk", c.scale_walk, spec("1/sqrt(s)", at_least(0), "random walk of the scale"));
  f.number("bias_sigma", c.bias_sigma, spec("m/s", positive(), "bias before anything is known"));
  f.number("bias_walk", c.bias_walk, spec("m/s/sqrt(s)", at_least(0), "random walk of the bias"));
  f.number("trusted", c.trusted,
           spec("-", in_range(0.0, 1.0),
                "weight of the weakest axis, smoothed over a second, "
                "above which the LiDAR teaches the legs"));
}

void describe(Fields& f, LegEvidenceConfig& c) {
  describe_switch(f, c, "leg noise from stance, spread among stance legs, turning and packet age");
}

void describe(Fields& f, DisagreementConfig& c) {
  describe_switch(f, c, "take weight from the LiDAR, or the legs, where they disagree for long");
}

void describe(Fields& f, StandstillConfig& c) {
  describe_switch(f, c, "zero-velocity update while the robot stands still");
}

void describe(Fields& f, FloorConfig& c) {
  describe_switch(f, c, "hold height and tilt by a level floor");
  f.number("radius", c.radius, spec("m", positive(), "where the floor is sought"));
  f.number("min_height", c.min_height, spec("m", positive(), "least height above the floor"));
  f.number("max_height", c.max_height, spec("m", positive(), "greatest height above the floor"));
  f.number("max_slope", c.max_slope,
           spec("-", positive(), "of the floor in body axes, where it is sought"));
  f.number("band", c.band, spec("m", positive(), "points this close to the floor are on it"));
  f.integer("min_points", c.min_points, spec("-", at_least(3), "points that make a floor"));
  f.number("min_spread", c.min_spread,
           spec("m", positive(), "least deviation of the floor's points along any direction"));
  f.number("max_residual", c.max_residual,
           spec("m", positive(), "root mean square distance of the floor's points from it"));
  f.number("bend", c.bend, spec("m", positive(), "a part of the floor further off is not level"));
  f.number("tilt", c.tilt, spec("rad", positive(), "a floor less tilted is level"));
  f.number(
      "max_tilt", c.max_tilt,
      spec("rad", positive(), "a floor more tilted is not level, however unsure the attitude"));
  f.number("step", c.step, spec("m", positive(), "change of height that makes another floor"));
  f.number("settle", c.settle,
           spec("m", at_least(0), "way on level floor before it is believed again"));
  f.number("spacing", c.spacing, spec("m", at_least(0), "way between measurements of the floor"));
  f.number("correlation_length", c.correlation_length,
           spec("m", positive(), "over it the floor's unevenness repeats itself"));
  f.number("sigma_tilt", c.sigma_tilt, spec("rad", positive(), "unevenness of a level floor"));
  f.number("sigma_height", c.sigma_height, spec("m", positive(), "unevenness of a level floor"));
}

void describe(Fields& f, RobustConfig& c) {
  describe_switch(f, c, "weigh each point by its residual");
}

void describe(Fields& f, DirectionalConfig& c) {
  f.group("spurious", c.spurious);
  f.group("leg_states", c.leg_states);
  f.group("leg_evidence", c.leg_evidence);
  f.group("disagreement", c.disagreement);
  f.group("standstill", c.standstill);
  f.group("floor", c.floor);
  f.group("robust", c.robust);
}

}  // namespace aims
