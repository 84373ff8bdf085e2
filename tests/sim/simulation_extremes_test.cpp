// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <sys/resource.h>

#include <cmath>
#include <string>
#include <vector>

#include "sim/simulation.hpp"
#include "tests/support/parameter_bounds.hpp"

namespace aims {
namespace {

using testing::is_numeric;

constexpr long kMemoryLimit = 3'000'000;  ///< of the test's process [kB]

/// A short walk past a coarse LiDAR, with everything switched on that belongs to `key`.
SimulationConfig config_for(const std::string& key) {
  SimulationConfig config;
  config.route.points = {{"a", 0.0, 0.0}, {"b", 2.0, 0.0}};
  config.lidar.columns = 32;
  config.lidar.rings = 2;
  SceneConfig& scene = config.scene;
  if (key.starts_with("scene.garage")) scene.kind = SceneKind::kGarage;
  if (key.starts_with("scene.junction")) scene.kind = SceneKind::kJunction;
  if (key.starts_with("scene.tunnel")) scene.kind = SceneKind::kTunnel;
  if (key.starts_with("scene.bumps")) scene.bumps.height = 0.01;
  if (key.starts_with("scene.ramp")) scene.ramp.grade = 0.05;
  if (key.starts_with("scene.people")) scene.people.count = 2;
  if (key.starts_with("scene.corridor.pillars")) scene.corridor.pillars.spacing = 5.0;
  if (key.starts_with("scene.corridor.clutter")) scene.corridor.clutter.density = 0.5;
  if (key.starts_with("scene.corridor.glass")) scene.corridor.glass.fraction = 0.5;
  if (key.starts_with("scene.corridor.bends")) scene.corridor.bends = {{0.5, 45.0, Side::kLeft}};
  if (key.starts_with("push")) config.push.count = 2;
  config.links.lidar.outage = {.start = 0.0, .duration = 0.05};
  return config;
}

std::string text_for(const Parameter& parameter, double value) {
  const std::string one = fmt::format("{}", value);
  if (!is_sequence(parameter)) return one;
  return parameter.expected.starts_with("three") ? fmt::format("[{0}, {0}, {0}]", one)
                                                 : fmt::format("[{0}, {0}]", one);
}

/// Simulates a little of it, unless it is refused; a refusal names a key.
void expect_simulated_or_refused(const SimulationConfig& config, const std::string& what) {
  auto simulation = Simulation::create(config, 1);
  if (!simulation) {
    EXPECT_NE(simulation.error().message.find(':'), std::string::npos)
        << what << ": " << simulation.error().message;
    return;
  }
  std::vector<Delivery> deliveries;
  simulation->advance(20 * kMillisecond, deliveries);
  EXPECT_TRUE(simulation->truth().samples.back().T_world_body.translation.allFinite()) << what;
}

TEST(SimulationExtremes, EachNumberAtEitherEndIsSimulatedOrRefused) {
  SimulationConfig defaults;
  defaults.scene.corridor.bends.resize(1);
  for (const Parameter& parameter : fields_of(defaults).parameters()) {
    if (!is_numeric(parameter)) continue;
    for (const double value : {parameter.spec.range.min, parameter.spec.range.max}) {
      SimulationConfig config = config_for(parameter.key);
      const Fields fields = fields_of(config);
      // The bound itself may be excluded, and a point of the longer default route be missing.
      if (!assign(fields, parameter.key, text_for(parameter, value))) continue;
      expect_simulated_or_refused(config, fmt::format("{} = {}", parameter.key, value));
    }
  }
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  EXPECT_LT(usage.ru_maxrss, kMemoryLimit);
}

/// All numbers of each kind of scene at once: sizes multiply.
TEST(SimulationExtremes, TheLargestAndTheSmallestSceneOfEachKindAreBuiltOrRefused) {
  for (const char* kind : {"corridor", "garage", "junction", "tunnel"}) {
    for (const bool largest : {false, true}) {
      SimulationConfig config = config_for(fmt::format("scene.{}", kind));
      const Fields fields = fields_of(config);
      for (const Parameter& parameter : fields.parameters()) {
        if (!is_numeric(parameter)) continue;
        const bool of_kind = parameter.key.starts_with(fmt::format("scene.{}.", kind)) ||
                             parameter.key.starts_with("scene.bumps.");
        const Range& range = parameter.spec.range;
        if (of_kind) (void)parameter.assign(text_for(parameter, largest ? range.max : range.min));
      }
      config.scene.bumps.correlation_length = 0.2;
      expect_simulated_or_refused(config, kind);
    }
  }
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  EXPECT_LT(usage.ru_maxrss, kMemoryLimit);
}

TEST(SimulationExtremes, ALongStandingTimeIsNoShortOne) {
  SimulationConfig config = config_for("route");
  config.route.stand_before = 1e6;
  Simulation simulation = Simulation::create(config, 1).value();
  std::vector<Delivery> deliveries;
  simulation.advance(kSecond, deliveries);
  EXPECT_TRUE(simulation.truth().waypoint_times.empty()) << "it has set off at once";
  SimulationConfig beyond = config;
  EXPECT_FALSE(assign(fields_of(beyond), "route.stand_before", "9.3e9"));
}

TEST(SimulationExtremes, ATimeLimitWhoseTruthFillsTheMemoryIsRefused) {
  SimulationConfig config = config_for("max_duration");
  config.physics.timestep = 0.0005;
  config.max_duration = 1e5;
  const auto refused = Simulation::create(config, 1);
  ASSERT_FALSE(refused.has_value());
  EXPECT_NE(refused.error().message.find("max_duration"), std::string::npos);
}

}  // namespace
}  // namespace aims
