// SPDX-License-Identifier: BSD-3-Clause
#include "sim/robot/swing_path.hpp"

#include <algorithm>

namespace aims {
namespace {

/// A value between 0 and 1 over a parameter from 0 to 1, and its derivative.
struct Blend {
  double value;
  double rate;
};

/// Minimum jerk.
Blend smooth(double s) {
  return {s * s * s * (10.0 + s * (-15.0 + 6.0 * s)), 30.0 * s * s * (1.0 - s) * (1.0 - s)};
}

/// Speed that rises in a straight line, stays, and falls in a straight line to `-retraction` times
/// its plateau.
Blend ramped(const SwingPathConfig& config, double s) {
  const double a = config.speed_up;
  const double b = config.slow_down;
  const double plateau = 1.0 / (1.0 - 0.5 * a - 0.5 * b * (1.0 + config.retraction));
  if (s < a) return {0.5 * plateau * s * s / a, plateau * s / a};
  if (s < 1.0 - b) return {plateau * (s - 0.5 * a), plateau};
  const double left = 1.0 - s;
  const double slope = plateau * (1.0 + config.retraction) / b;
  const double end = -config.retraction * plateau;
  return {1.0 - end * left - 0.5 * slope * left * left, end + slope * left};
}

/// Cubic from 0 to 1 that begins at rest and ends with that rate.
Blend landing(double s, double rate) {
  return {s * s * (3.0 - 2.0 * s + rate * (s - 1.0)), s * (6.0 * (1.0 - s) + rate * (3.0 * s - 2.0))};
}

SwingPoint minimum_jerk_point(const Swing& swing, double s) {
  const Blend along = smooth(s);
  SwingPoint point;
  point.position = swing.from + along.value * (swing.to - swing.from);
  point.velocity = along.rate / swing.time * (swing.to - swing.from);
  // Height: up to the apex in the first half, down in the second.
  const bool rising = s < 0.5;
  const Blend height = smooth(rising ? 2.0 * s : 2.0 * s - 1.0);
  const double start = rising ? swing.from.z() : swing.apex;
  const double span = (rising ? swing.apex : swing.to.z()) - start;
  point.position.z() = start + height.value * span;
  point.velocity.z() = 2.0 * height.rate / swing.time * span;
  return point;
}

SwingPoint ramped_point(const SwingPathConfig& config, const Swing& swing, double s) {
  const Blend along = ramped(config, s);
  SwingPoint point;
  point.position = swing.from + along.value * (swing.to - swing.from);
  point.velocity = along.rate / swing.time * (swing.to - swing.from);
  if (s < 0.5) {
    const double length = 0.5 - config.lift;
    const double part = std::max(0.0, (s - config.lift) / length);
    const Blend height = landing(part, 0.0);
    const double span = swing.apex - swing.from.z();
    point.position.z() = swing.from.z() + height.value * span;
    point.velocity.z() = height.rate / (length * swing.time) * span;
    return point;
  }
  const double span = swing.apex - swing.to.z();
  const double rate = span > 0.0 ? config.descent * 0.5 * swing.time / span : 0.0;
  const Blend height = landing(2.0 * s - 1.0, std::min(rate, 3.0));  // beyond 3 it rises first
  point.position.z() = swing.apex - height.value * span;
  point.velocity.z() = -2.0 * height.rate / swing.time * span;
  return point;
}

}  // namespace

SwingPoint swing_point(const SwingPathConfig& config, const Swing& swing, double s) {
  return config.shape == SwingShape::kRamped ? ramped_point(config, swing, s)
                                             : minimum_jerk_point(swing, s);
}

void describe(Fields& f, SwingPathConfig& c) {
  f.choice("shape", c.shape,
           {{"minimum_jerk", SwingShape::kMinimumJerk}, {"ramped", SwingShape::kRamped}},
           {.meaning = "Path of a swinging foot: at rest over the ground at both ends, or with "
                       "quick ramps of its speed and landing in motion."});
  f.number("speed_up", c.speed_up,
           {.unit = "-",
            .range = in_range(0.02, 0.45),
            .meaning = "Part of a ramped swing in which the foot gains its speed."});
  f.number("slow_down", c.slow_down,
           {.unit = "-",
            .range = in_range(0.02, 0.45),
            .meaning = "Part of a ramped swing in which the foot loses its speed."});
  f.number("retraction", c.retraction,
           {.unit = "-",
            .range = in_range(0.0, 0.5),
            .meaning = "Backward speed of a ramped swing at touchdown over its largest speed."});
  f.number("lift", c.lift,
           {.unit = "-",
            .range = in_range(0.0, 0.3),
            .meaning = "Part of a ramped swing in which the foot moves before it rises."});
  f.number("descent", c.descent,
           {.unit = "m/s",
            .range = in_range(0.0, 3.0),
            .meaning = "Downward speed of a ramped swing at touchdown."});
}

}  // namespace aims
