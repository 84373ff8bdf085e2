// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <initializer_list>

#include "bench/scenario/scenario.hpp"
#include "sim/simulation.hpp"

namespace aims {
namespace {

void expect_every_scenario_to_be_walkable(std::initializer_list<std::uint64_t> seeds) {
  const auto files = scenario_files(AIMS_SCENARIOS);
  ASSERT_TRUE(files.has_value()) << files.error().message;
  ASSERT_GT(files->size(), 50U);
  for (const std::filesystem::path& file : *files) {
    const auto scenario = load_scenario(file, {});
    ASSERT_TRUE(scenario.has_value()) << scenario.error().message;
    for (const std::uint64_t seed : seeds) {
      const auto ready = Simulation::create(scenario_of_seed(*scenario, seed).simulation, seed);
      EXPECT_TRUE(ready.has_value()) << file << " seed " << seed << ": " << ready.error().message;
    }
  }
}

TEST(ScenarioRoutes, EveryShippedScenarioCanBeWalked) { expect_every_scenario_to_be_walkable({1}); }

TEST(ScenarioRoutes, EveryShippedScenarioCanBeWalkedOnOtherSeeds) {
  expect_every_scenario_to_be_walkable({2, 7});
}

}  // namespace
}  // namespace aims
