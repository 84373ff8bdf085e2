// SPDX-License-Identifier: BSD-3-Clause
#include "sim/simulation_config.hpp"

#include <fmt/format.h>

#include "sim/sensors/sampling.hpp"

namespace aims {

void describe(Fields& f, PhysicsConfig& c) {
  f.number("timestep", c.timestep,
           {.unit = "s",
            .range = in_range(0.0005, 0.005),
            .meaning = "step of the integrator; divides the period of every sensor",
            .source = "2.5 ms divides the periods of 50 Hz and 200 Hz, 2 ms does not"});
}

void describe(Fields& f, RobotConfig& c) {
  f.number("start_position_sigma", c.start_position_sigma,
           {.unit = "m",
            .range = in_range(0.0, 0.05),
            .meaning = "standard deviation per axis of the start about the route's first point"});
  f.number(
      "start_heading_sigma", c.start_heading_sigma,
      {.unit = "rad",
       .range = in_range(0.0, 0.1),
       .meaning = "standard deviation of the heading at the start; each run walks its own way"});
  f.group("gait", c.gait);
}

void describe(Fields& f, LinksConfig& c) {
  f.group("imu", c.imu);
  f.group("leg_odometry", c.leg_odometry);
  f.group("lidar", c.lidar);
}

void describe(Fields& f, SimulationConfig& c) {
  f.group("scene", c.scene);
  f.group("route", c.route);
  f.group("physics", c.physics);
  f.group("robot", c.robot);
  f.group("push", c.push);
  f.group("imu", c.imu);
  f.group("leg_odometry", c.leg_odometry);
  f.group("lidar", c.lidar);
  f.group("links", c.links);
  f.number(
      "fast_imu_rate", c.fast_imu_rate,
      {.unit = "Hz",
       .range = in_range(0.0, 2000.0),
       .meaning = "of a second output of the IMU, for recordings; estimators here do not get it",
       .source = "other systems ask for 200 Hz or more; 0: none"});
  f.number("recording_start", c.recording_start,
           {.unit = "s",
            .range = at_least(0),
            .meaning = "sensors are off until then, while the robot already walks"});
  f.number("max_duration", c.max_duration,
           {.unit = "s",
            .range = positive(),
            .meaning = "simulated time after which the run ends, finished or not"});
}

Result<void> validate(const SimulationConfig& config) {
  const Duration timestep = from_seconds(config.physics.timestep);
  if (auto ok = validate(config.scene); !ok) return ok;
  if (auto ok = validate(config.route); !ok) return ok;
  if (auto ok = validate(config.push); !ok) return ok;
  if (auto ok = validate(config.lidar); !ok) return ok;
  if (auto ok = validate(config.imu, timestep); !ok) return ok;
  if (auto ok = validate(config.leg_odometry, timestep); !ok) return ok;
  if (config.fast_imu_rate > 0.0) {
    const auto steps = steps_per_sample("fast_imu_rate", config.fast_imu_rate, timestep);
    if (!steps) return tl::unexpected(steps.error());
  }
  const auto scan = steps_per_sample("lidar.rate", config.lidar.rate, timestep);
  if (!scan) return tl::unexpected(scan.error());
  if (config.recording_start >= config.max_duration) {
    return failure(fmt::format("recording_start: expected less than {} s (max_duration), got {}",
                               config.max_duration, config.recording_start));
  }
  return {};
}

}  // namespace aims
