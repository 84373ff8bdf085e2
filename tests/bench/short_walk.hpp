// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <string>

#include "bench/scenario/scenario.hpp"

namespace aims::testing {

/// A metre of a corridor, after a start of 2.5 s.
inline Scenario short_walk(const std::string& name = "short") {
  Scenario scenario;
  scenario.name = name;
  scenario.run = {"aims"};
  scenario.simulation.scene.corridor.length = 10.0;
  scenario.simulation.route.points = {{"a", 0.0, 0.0}, {"b", 1.0, 0.0}};
  scenario.simulation.route.stand_before = 2.5;
  scenario.simulation.lidar.columns = 300;
  return scenario;
}

/// A robot that would start in a wall.
inline Scenario in_wall() {
  Scenario scenario = short_walk("in_wall");
  scenario.simulation.route.points = {{"a", 0.0, 1.1}, {"b", 3.0, 1.1}};
  return scenario;
}

inline std::shared_ptr<const Scenario> shared(Scenario scenario) {
  return std::make_shared<const Scenario>(std::move(scenario));
}

}  // namespace aims::testing
