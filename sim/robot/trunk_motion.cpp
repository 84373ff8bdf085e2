// SPDX-License-Identifier: BSD-3-Clause
#include "sim/robot/trunk_motion.hpp"

#include <cmath>
#include <numbers>

namespace aims {
namespace {

constexpr const char* kSource = "fitted to the IMU of a trotting Unitree Go1";

/// Phase of the pitch ahead of mid-stance [rad]: of all it makes the feet slip least.
constexpr double kPitchLead = 1.2;

/// Value, rate and acceleration of amplitude * cos(angle), whose angle turns at `speed` [rad/s].
struct Oscillation {
  Oscillation(double amplitude, double angle, double speed)
      : value(amplitude * std::cos(angle)),
        rate(-amplitude * speed * std::sin(angle)),
        acceleration(-speed * speed * value) {}
  double value;
  double rate;
  double acceleration;
};

}  // namespace

TrunkReference trunk_reference(const TrunkMotionConfig& config, double phase, double duty_factor,
                               double period) {
  const double angle = 2.0 * std::numbers::pi * (phase - 0.5 * duty_factor);
  const double speed = 2.0 * std::numbers::pi / period;
  const Oscillation bounce(config.vault - config.bounce, 2.0 * angle, 2.0 * speed);
  const Oscillation roll(config.roll, angle - 0.5 * std::numbers::pi, speed);
  const Oscillation pitch(config.pitch, 2.0 * angle + kPitchLead, 2.0 * speed);
  TrunkReference reference;
  reference.height = bounce.value;
  reference.velocity = bounce.rate;
  reference.acceleration = bounce.acceleration;
  reference.tilt = {roll.value, pitch.value, 0.0};
  reference.rate = {roll.rate, pitch.rate, 0.0};
  reference.angular_acceleration = {roll.acceleration, pitch.acceleration, 0.0};
  return reference;
}

TrunkReference operator*(double fraction, const TrunkReference& reference) {
  return {fraction * reference.height,       fraction * reference.velocity,
          fraction * reference.acceleration, fraction * reference.tilt,
          fraction * reference.rate,         fraction * reference.angular_acceleration};
}

void describe(Fields& f, TrunkMotionConfig& c) {
  f.number("bounce", c.bounce,
           {.unit = "m",
            .range = in_range(0.0, 0.02),
            .meaning = "Amplitude of the trunk's height, twice per stride, lowest in mid-stance.",
            .source = kSource});
  f.number("vault", c.vault,
           {.unit = "m",
            .range = in_range(0.0, 0.02),
            .meaning = "Amplitude of the trunk's height over its standing legs, twice per stride, "
                       "highest in mid-stance."});
  f.number("roll", c.roll,
           {.unit = "rad",
            .range = in_range(0.0, 0.2),
            .meaning = "Amplitude of the trunk's roll, once per stride.",
            .source = kSource});
  f.number("pitch", c.pitch,
           {.unit = "rad",
            .range = in_range(0.0, 0.2),
            .meaning = "Amplitude of the trunk's pitch, twice per stride.",
            .source = kSource});
}

}  // namespace aims
