// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <string>

#include "bench/studies/suite.hpp"
#include "tests/support/temporary_folder.hpp"

namespace aims::test {

/// A robot that walks one metre along a corridor: a run takes a fraction of a second.
inline Scenario short_walk(const std::string& name = "short_walk") {
  Scenario scenario;
  scenario.name = name;
  scenario.run = {"aims", "leg"};
  scenario.simulation.scene.corridor.length = 10.0;
  scenario.simulation.route.points = {{"a", 0.0, 0.0}, {"b", 1.0, 0.0}};
  scenario.simulation.route.stand_before = 2.5;
  return scenario;
}

/// Two seeds into `out`; all tests of a process share the sequences.
inline SuiteOptions options_for(const std::filesystem::path& out, int jobs = 1) {
  static const TemporaryFolder cache;
  SuiteOptions options;
  options.seeds = {1, 2};
  options.jobs.out = out;
  options.jobs.cache = cache.path();
  options.jobs.jobs = jobs;
  return options;
}

/// An observer that lets a run go on to its end.
inline constexpr auto keep_going = [](const auto&...) { return true; };

}  // namespace aims::test
