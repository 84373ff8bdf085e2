// SPDX-License-Identifier: BSD-3-Clause
#include "sim/simulation_config.hpp"

#include <fmt/format.h>

#include "core/random.hpp"
#include "sim/sensors/sampling.hpp"

namespace aims {
namespace {

/// Of the physics in a run: each leaves a sample of the truth, of about 200 bytes.
constexpr int kMaxSteps = 40'000'000;

}  // namespace

void describe(Fields& f, PhysicsConfig& c) {
  f.number("timestep", c.timestep,
           {.unit = "s",
            .range = in_range(0.0005, 0.005),
            .meaning = "Time step of the integrator; every sensor period is a multiple of it.",
            .source = "2.5 ms divides the periods of 50 Hz and 200 Hz, 2 ms does not"});
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
  f.group("calibration", c.calibration);
  f.group("links", c.links);
  f.number(
      "fast_imu_rate", c.fast_imu_rate,
      {.unit = "Hz",
       .range = in_range(0.0, 2000.0),
       .meaning = "Rate of a second IMU output for recordings, which the estimators do not use; "
                  "0 for none.",
       .source = "other systems need 200 Hz or more"});
  f.number("recording_start", c.recording_start,
           {.unit = "s",
            .range = up_to(1e5),
            .meaning = "Time at which the sensors are switched on; the robot walks from time 0."});
  f.integer("robot_seed", c.robot_seed,
            {.unit = "-",
             .range = in_range(0, 2147483647),
             .meaning = "Seed of what belongs to the robot: dimensions, mounts, constant errors of "
                        "its sensors, and their draws; 0 for the seed of the run."});
  f.text(
      "sensor_draw", c.sensor_draw,
      {.meaning = "Name of a draw of the sensors' errors and noise of its own, of the same seed; "
                  "'scenario' for the name of the scenario, empty for that of the seed."});
  f.number(
      "max_duration", c.max_duration,
      {.unit = "s",
       .range = positive_up_to(1e5),
       .meaning = "Simulated time after which the run ends, whether or not the route is done."});
}

RunSeeds run_seeds(const SimulationConfig& config, std::uint64_t seed) {
  const std::uint64_t robot =
      config.robot_seed > 0 ? static_cast<std::uint64_t>(config.robot_seed) : seed;
  if (config.sensor_draw.empty()) return {seed, robot};
  const auto own = [&](std::uint64_t of) {
    return static_cast<std::uint64_t>(0x1p53 * rng(of, "sensors." + config.sensor_draw).uniform());
  };
  return {own(seed), own(robot)};
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
  if (config.max_duration > kMaxSteps * config.physics.timestep) {
    return failure(
        fmt::format("max_duration: expected at most {} s ({} steps of {} s, whose truth is kept in "
                    "memory), got {}",
                    kMaxSteps * config.physics.timestep, kMaxSteps, config.physics.timestep,
                    config.max_duration));
  }
  if (config.recording_start >= config.max_duration) {
    return failure(fmt::format("recording_start: expected less than {} s (max_duration), got {}",
                               config.max_duration, config.recording_start));
  }
  return {};
}

}  // namespace aims
