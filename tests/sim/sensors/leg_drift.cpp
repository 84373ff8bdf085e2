// SPDX-License-Identifier: BSD-3-Clause
#include "tests/sim/sensors/leg_drift.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "core/files/yaml_config.hpp"

namespace aims::testing {
namespace {

constexpr double kLength = 10.0;     ///< of either way [m]
constexpr double kTurnRadius = 0.4;  ///< about the far end: nearer, the robot turns or stops [m]

/// True and reported place of the base at one instant.
struct Place {
  Eigen::Vector3d actual;
  Eigen::Vector3d reported;
};

/// Places at the samples of the odometry.
std::vector<Place> places_of(const Walk& walk, const LegOdometryConfig& config,
                             std::uint64_t seed) {
  LegOdometry odometry(config, kRobotGeometry, from_seconds(kTimestep), seed);
  std::vector<Place> places;
  for (const RobotState& state : walk.states) {
    if (const auto sample = odometry.sample(state)) {
      places.push_back({state.T_world_base.translation, sample->T_odom_base.translation});
    }
  }
  return places;
}

double relative_error(const Place& from, const Place& to) {
  return (to.reported - from.reported).head<2>().norm() /
             (to.actual - from.actual).head<2>().norm() -
         1.0;
}

}  // namespace

SimulationConfig config_at(SensorLevel level) {
  SimulationConfig config;
  for (const SensorPreset& preset : sensor_presets(level, ImuGrade::kOfLevel)) {
    const auto loaded =
        load_config_text(std::string(preset.text), std::string(preset.name), config);
    if (!loaded) throw std::runtime_error(loaded.error().message);
  }
  return config;
}

LegOdometryConfig without_errors(const LegOdometryConfig& config) {
  LegOdometryConfig c = config;
  c.link_length_error = c.joint_stiffness = c.foot_stiffness = 0.0;
  c.joint_angle_noise = c.joint_angle_offset = c.joint_angle_resolution = 0.0;
  c.joint_rate_noise = c.joint_rate_window = c.encoder_delay = 0.0;
  c.load_noise = c.load_zero = c.load_offset = c.load_scale_error = 0.0;
  c.load_rise_time = c.load_hold = c.load_fall_time = c.load_latency = 0.0;
  c.gyro_noise_density = c.gyro_bias = c.gyro_scale_error = 0.0;
  c.velocity_scale = 1.0;
  c.velocity_scale_error = c.slip_rate = 0.0;
  return c;
}

Walk drift_walk(const SimulationConfig& config, double friction, std::uint64_t seed) {
  WorldSetup setup = corridor_world(kLength, friction, 0.0, seed);
  setup.legs =
      built_legs(kRobotGeometry, {.link_length = config.leg_odometry.link_length_error}, seed);
  return walk(setup, there_and_back(kLength), config.robot.gait);
}

Walk square_walk(const SimulationConfig& config, double friction, std::uint64_t seed) {
  SceneConfig hall;
  hall.corridor.length = 10.0;
  hall.corridor.width = 10.0;
  const Scene scene = build_scene(hall, seed);
  const WorldSetup setup = {
      scene_mjcf(scene, robot_models().front().mjcf, MjcfPurpose::kPhysics).value(),
      {},
      kTimestep,
      friction,
      built_legs(kRobotGeometry, {.link_length = config.leg_odometry.link_length_error}, seed)};
  RouteConfig route;
  route.points = {{"a", 0.0, 0.0}, {"", 3.2, 0.0}, {"", 3.2, 3.4}, {"", 0.0, 3.4}, {"a", 0.0, 0.0}};
  route.stand_before = 0.5;
  return walk(setup, route, config.robot.gait);
}

double path_error(const Walk& walk, const SimulationConfig& config, std::uint64_t seed) {
  const LegOdometryConfig& legs = config.leg_odometry;
  const std::vector<Place> places = places_of(walk, legs, seed);
  const auto stride = static_cast<std::size_t>(std::lround(config.robot.gait.period * legs.rate));
  double actual = 0.0;
  double reported = 0.0;
  for (std::size_t i = stride; i < places.size(); i += stride) {
    actual += (places[i].actual - places[i - stride].actual).head<2>().norm();
    reported += (places[i].reported - places[i - stride].reported).head<2>().norm();
  }
  return reported / actual - 1.0;
}

LegDrift drift_of(const Walk& walk, const LegOdometryConfig& config, std::uint64_t seed) {
  const std::vector<Place> places = places_of(walk, config, seed);
  const auto at_far_end = [](const Place& place) {
    return place.actual.x() > kLength - kTurnRadius;
  };
  const auto arrival = std::find_if(places.begin(), places.end(), at_far_end);
  const auto departure = std::find_if(places.rbegin(), places.rend(), at_far_end).base() - 1;
  LegDrift drift;
  drift.out = relative_error(places.front(), *arrival);
  drift.back = relative_error(*departure, places.back());
  const Eigen::Vector3d moved = departure->actual - arrival->actual;
  drift.turn = (departure->reported - arrival->reported).head<2>().norm() - moved.head<2>().norm();
  const double climbed = places.back().actual.z() - places.front().actual.z();
  drift.height =
      (places.back().reported.z() - places.front().reported.z() - climbed) / (2.0 * kLength);
  return drift;
}

}  // namespace aims::testing
