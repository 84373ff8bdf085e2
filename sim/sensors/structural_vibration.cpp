// SPDX-License-Identifier: BSD-3-Clause
#include "sim/sensors/structural_vibration.hpp"

#include <cmath>

namespace aims {
namespace {

constexpr double kFloorBandwidth = 200.0;  ///< [Hz]

/// Gains of the two diagonals on each axis: the same size, signs at random.
Eigen::Matrix<double, 3, 2> drawn_gains(const Eigen::Vector3d& level, double variation,
                                        RandomStream& random) {
  Eigen::Matrix<double, 3, 2> gains;
  for (int axis = 0; axis < 3; ++axis) {
    const double size = level[axis] * std::exp(variation * random.normal());
    for (int diagonal = 0; diagonal < 2; ++diagonal) {
      gains(axis, diagonal) = random.chance(0.5) ? size : -size;
    }
  }
  return gains;
}

}  // namespace

StructuralVibration::StructuralVibration(const VibrationConfig& config, double timestep,
                                         RunSeeds seeds)
    : floor_(seeds.run, "imu.vibration.floor") {
  // White noise of a step has its power up to half the physics rate.
  const double scale = std::sqrt(0.5 / timestep / kFloorBandwidth);
  floor_acceleration_ = scale * config.floor_acceleration;
  floor_rate_ = scale * config.floor_rate;
  if (config.level <= 0.0) return;
  RandomStream random(seeds.robot, "imu.vibration");
  for (const VibrationMode& mode : config.modes) {
    modes_.push_back({SecondOrderSystem(mode.frequency, config.damping, timestep),
                      drawn_gains(config.level * mode.acceleration, config.variation, random),
                      drawn_gains(config.level * mode.rate, config.variation, random)});
    // All feet push the trunk upwards.
    modes_.back().acceleration.row(2) = modes_.back().acceleration.row(2).cwiseAbs();
  }
}

Vibration StructuralVibration::step(const FootLoads& foot_load) {
  Vibration sum;
  if (floor_acceleration_ > 0.0 || floor_rate_ > 0.0) {
    sum.acceleration = floor_acceleration_ * floor_.normal3();
    sum.rate = floor_rate_ * floor_.normal3();
  }
  const Eigen::Vector3d loads(foot_load[0] + foot_load[3], foot_load[1] + foot_load[2], 0.0);
  for (Mode& mode : modes_) {
    if (!started_) mode.system.settle(loads);
    mode.system.step(loads);
    const Eigen::Vector2d ringing = mode.system.band().head<2>();
    sum.acceleration += mode.acceleration * ringing;
    sum.rate += mode.rate * ringing;
  }
  started_ = true;
  return sum;
}

std::vector<VibrationMode> VibrationConfig::go1_modes() {
  return {{18.0, {0.070, 0.074, 0.0}, {7.8e-3, 7.3e-3, 1.55e-3}},
          {35.0, {0.038, 0.031, 0.0}, {3.2e-3, 4.4e-3, 2.15e-3}},
          {75.0, {0.139, 0.093, 0.042}, {5.3e-3, 2.8e-3, 2.4e-3}},
          {140.0, {0.136, 0.085, 0.018}, {8.6e-3, 3.4e-3, 4.1e-3}}};
}

void describe(Fields& f, VibrationMode& c) {
  f.number("frequency", c.frequency,
           {.unit = "Hz", .range = in_range(5.0, 150.0), .meaning = "Natural frequency."});
  f.vector("acceleration", c.acceleration,
           {.unit = "m/s^2 per N",
            .range = within(10.0),
            .meaning = "Amplitude per axis under a force of 1 N at that frequency."});
  f.vector("rate", c.rate,
           {.unit = "rad/s per N",
            .range = within(1.0),
            .meaning = "Amplitude per axis under a force of 1 N at that frequency."});
}

void describe(Fields& f, VibrationConfig& c) {
  const char* const source = "the IMU of a trotting and a standing Unitree Go1";
  f.number("level", c.level,
           {.unit = "-",
            .range = in_range(0.0, 20.0),
            .meaning = "Factor on the modes' levels: vibration by footfalls; 0 for none.",
            .source = source});
  f.number("damping", c.damping,
           {.unit = "-",
            .range = in_range(0.005, 0.9),
            .meaning = "Damping ratio of each mode.",
            .source = "assumption: a trunk of plastic and screws"});
  f.number("variation", c.variation,
           {.unit = "-",
            .range = in_range(0.0, 1.0),
            .meaning = "Standard deviation of the logarithm of each level from run to run.",
            .source = "assumption"});
  f.number("floor_acceleration", c.floor_acceleration,
           {.unit = "m/s^2",
            .range = up_to(100.0),
            .meaning = "White vibration by motors and electronics up to 200 Hz, standard deviation "
                       "per axis.",
            .source = source});
  f.number("floor_rate", c.floor_rate,
           {.unit = "rad/s",
            .range = up_to(10.0),
            .meaning = "The same of the angular velocity.",
            .source = source});
  f.list("modes", c.modes, "Modes of the structure; the levels are those of a Unitree Go1.");
  f.idle_if(c.level <= 0.0, "level is 0", {"damping", "variation", "modes"});
}

}  // namespace aims
