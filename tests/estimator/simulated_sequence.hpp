// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <utility>
#include <vector>

#include "sim/simulation.hpp"

namespace aims::testing {

/// The measurements of a simulated sequence and its truth.
struct SimulatedSequence {
  std::vector<Delivery> deliveries;  ///< in order of arrival
  Truth truth;
  SensorRig rig;
};

/// Simulates the whole route of a valid configuration.
inline SimulatedSequence simulate(const SimulationConfig& config, std::uint64_t seed) {
  Simulation simulation = Simulation::create(config, seed).value();
  SimulatedSequence sequence;
  while (simulation.advance(kSecond, sequence.deliveries)) {
  }
  sequence.truth = simulation.truth();
  sequence.rig = simulation.rig();
  return sequence;
}

/// A straight corridor from a to b, `length` [m] apart, with a LiDAR of `columns` firings per scan.
inline SimulationConfig straight_sequence(double length, int columns) {
  SimulationConfig config;
  config.scene.corridor.length = length;
  config.route.points = {{"a", 0.0, 0.0}, {"b", length, 0.0}};
  config.route.stand_before = 3.0;
  config.route.stand_after = 0.5;
  config.lidar.columns = columns;
  return config;
}

}  // namespace aims::testing
