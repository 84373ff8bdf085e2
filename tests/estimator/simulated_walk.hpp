// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <utility>
#include <vector>

#include "sim/simulation.hpp"

namespace aims::testing {

/// What a simulated walk delivered, and what was true of it.
struct SimulatedWalk {
  std::vector<Delivery> deliveries;  ///< in order of arrival
  Truth truth;
  SensorRig rig;
};

/// Walks the whole route of a valid configuration.
inline SimulatedWalk simulate(const SimulationConfig& config, std::uint64_t seed) {
  Simulation simulation = Simulation::create(config, seed).value();
  SimulatedWalk walk;
  while (simulation.advance(kSecond, walk.deliveries)) {
  }
  walk.truth = simulation.truth();
  walk.rig = simulation.rig();
  return walk;
}

/// A straight corridor from a to b, `length` [m] apart, seen by a LiDAR of `columns` firings.
inline SimulationConfig straight_walk(double length, int columns) {
  SimulationConfig config;
  config.scene.corridor.length = length;
  config.route.points = {{"a", 0.0, 0.0}, {"b", length, 0.0}};
  config.route.stand_before = 3.0;
  config.route.stand_after = 0.5;
  config.lidar.columns = columns;
  return config;
}

}  // namespace aims::testing
