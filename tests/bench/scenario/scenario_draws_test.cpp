// SPDX-License-Identifier: BSD-3-Clause
#include "bench/scenario/scenario_draws.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "bench/scenario/scenario.hpp"
#include "core/files/atomic_file.hpp"
#include "sim/robot/scene_route.hpp"
#include "tests/support/temporary_folder.hpp"

namespace aims {
namespace {

const std::string kFolder = AIMS_SCENARIOS;

/// Seeds to choose on and seeds to report on.
std::vector<std::uint64_t> both_ranges() {
  std::vector<std::uint64_t> seeds;
  for (std::uint64_t seed = 1; seed <= 200; ++seed) seeds.push_back(seed);
  for (std::uint64_t seed = 2001; seed <= 2400; ++seed) seeds.push_back(seed);
  return seeds;
}

Scenario drawing(std::vector<Draw> draws) {
  Scenario scenario = default_scenario({}).value();
  scenario.draw = std::move(draws);
  EXPECT_TRUE(check_draws(scenario)) << check_draws(scenario).error().message;
  return scenario;
}

Draw range(std::string key, double min, double max) {
  Draw draw;
  draw.key = std::move(key);
  draw.min = min;
  draw.max = max;
  return draw;
}

std::string drawn(const Scenario& scenario, const std::string& key) {
  for (const DrawnValue& each : scenario.drawn) {
    if (each.key == key) return each.value;
  }
  return "";
}

double number(const Scenario& scenario, const std::string& key) {
  return std::stod(drawn(scenario, key));
}

/// Largest distance of the empirical distribution of values in [0, 1] from the uniform one.
double kolmogorov_distance(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  double largest = 0.0;
  for (std::size_t i = 0; i < values.size(); ++i) {
    const auto n = static_cast<double>(values.size());
    largest = std::max(largest, std::abs(values[i] - (static_cast<double>(i) + 0.5) / n) + 0.5 / n);
  }
  return largest;
}

/// Exceeded with probability 0.001 by such draws (asymptotic, for n above 100).
double kolmogorov_limit(std::size_t n) { return 1.95 / std::sqrt(static_cast<double>(n)); }

TEST(ScenarioDraws, AreUniformInTheirRanges) {
  Draw speed = range("route.speed", 0.3, 1.0);
  Draw reach = range("lidar.range_max", 20.0, 100.0);
  reach.scale = DrawScale::kLog;
  Draw people = range("scene.people.count", 0.0, 3.0);
  people.integer = true;
  Draw sides;
  sides.key = "scene.corridor.doors.sides";
  sides.values = {"left", "right", "both"};
  const Scenario scenario = drawing({speed, reach, people, sides});
  constexpr int kSeeds = 2000;
  std::vector<double> speeds;
  std::vector<double> reaches;
  std::map<std::string, int> counts;
  for (int seed = 1; seed <= kSeeds; ++seed) {
    const Scenario own = scenario_of_seed(scenario, static_cast<std::uint64_t>(seed));
    speeds.push_back((own.simulation.route.speed - 0.3) / 0.7);
    reaches.push_back(std::log(own.simulation.lidar.range_max / 20.0) / std::log(5.0));
    ++counts[drawn(own, "scene.people.count")];
    ++counts[drawn(own, "scene.corridor.doors.sides")];
  }
  EXPECT_LT(kolmogorov_distance(speeds), kolmogorov_limit(speeds.size()));
  EXPECT_LT(kolmogorov_distance(reaches), kolmogorov_limit(reaches.size()));
  ASSERT_EQ(counts.size(), 7U);  // 0 to 3 people, three sides
  for (const auto& [value, count] : counts) {
    const double share = value.size() == 1 ? 0.25 : 1.0 / 3.0;
    const double sigma = std::sqrt(kSeeds * share * (1.0 - share));
    EXPECT_NEAR(count, kSeeds * share, 4.0 * sigma) << value;
  }
}

TEST(ScenarioDraws, AreIndependentOfEachOther) {
  const Draw speed = range("route.speed", 0.3, 1.0);
  const Draw width = range("scene.corridor.width", 1.2, 4.0);
  const Scenario alone = drawing({speed});
  const Scenario together = drawing({width, speed});
  std::vector<double> products;
  for (std::uint64_t seed = 1; seed <= 500; ++seed) {
    const Scenario own = scenario_of_seed(together, seed);
    EXPECT_EQ(drawn(own, speed.key), drawn(scenario_of_seed(alone, seed), speed.key));
    products.push_back((own.simulation.route.speed - 0.65) / 0.7 *
                       (own.simulation.scene.corridor.width - 2.6) / 2.8);
  }
  double sum = 0.0;
  for (const double each : products) sum += each;
  // The product of two independent uniform numbers in [-1/2, 1/2] has the variance 1/144.
  EXPECT_LT(std::abs(sum), 4.0 * std::sqrt(500.0 / 144.0));
}

TEST(ScenarioDraws, ProbabilitiesAndConditionsDecide) {
  Draw bend = range("scene.ramp.grade", 0.02, 0.08);
  bend.probability = 0.3;
  Draw people = range("scene.people.count", 1.0, 3.0);
  people.integer = true;
  people.when = {"scene.ramp.grade<=0"};
  Draw slow = range("route.speed", 0.3, 0.4);
  slow.when = {"scene.people.count>=2"};
  const Draw fast = range("route.speed", 0.9, 1.0);
  const Scenario scenario = drawing({bend, people, slow, fast});
  int ramps = 0;
  for (std::uint64_t seed = 1; seed <= 1000; ++seed) {
    const SimulationConfig own = scenario_of_seed(scenario, seed).simulation;
    const bool ramp = own.scene.ramp.grade > 0.0;
    ramps += ramp ? 1 : 0;
    EXPECT_EQ(own.scene.people.count == 0, ramp);
    EXPECT_EQ(own.route.speed < 0.5, own.scene.people.count >= 2);
  }
  EXPECT_NEAR(ramps, 300, 4.0 * std::sqrt(1000 * 0.3 * 0.7));
}

TEST(ScenarioDraws, SameSeedSameBytesAndDrawnOnce) {
  for (const char* name : {"random_corridor", "random_garage", "random_robot"}) {
    const Scenario scenario = load_scenario(find_scenario(name, kFolder).value(), {}).value();
    EXPECT_FALSE(scenario.draw.empty());
    std::set<std::string> texts;
    for (const std::uint64_t seed : {1, 2, 3, 2001}) {
      const Scenario own = scenario_of_seed(scenario, seed);
      EXPECT_TRUE(own.draw.empty());
      const std::string text = effective_config(scenario, seed);
      EXPECT_EQ(text, effective_config(scenario_of_seed(scenario, seed), seed));
      EXPECT_EQ(text, effective_config(own, seed));
      texts.insert(config_text(own));
      // What is stored with results repeats the run.
      const TemporaryFolder folder;
      const auto file = folder.path() / "config.yaml";
      ASSERT_TRUE(write_file_atomically(file, text));
      const auto again = load_scenario(file, {});
      ASSERT_TRUE(again) << again.error().message;
      EXPECT_EQ(effective_config(*again, seed), text);
    }
    EXPECT_EQ(texts.size(), 4U);
  }
}

TEST(ScenarioDraws, SettingsOverrideThem) {
  const auto file = find_scenario("random_corridor", kFolder).value();
  const std::vector<std::string> settings = {"scene.corridor.width=2.5"};
  const Scenario scenario = load_scenario(file, settings).value();
  const Scenario free = load_scenario(file, {}).value();
  EXPECT_EQ(scenario.draw.size() + 1, free.draw.size());
  for (const std::uint64_t seed : {1, 2, 3}) {
    const Scenario own = scenario_of_seed(scenario, seed);
    EXPECT_EQ(own.simulation.scene.corridor.width, 2.5);
    EXPECT_EQ(drawn(own, "scene.corridor.width"), "");
    EXPECT_EQ(drawn(own, "scene.corridor.length"),
              drawn(scenario_of_seed(free, seed), "scene.corridor.length"));
  }
}

/// Every seed of both ranges yields a scene that can be built and a route that can be walked.
void expect_every_seed_builds(const char* name) {
  const Scenario scenario = load_scenario(find_scenario(name, kFolder).value(), {}).value();
  for (const std::uint64_t seed : both_ranges()) {
    const SimulationConfig own = scenario_of_seed(scenario, seed).simulation;
    const auto valid = validate(own);
    ASSERT_TRUE(valid) << name << " seed " << seed << ": " << valid.error().message;
    const Scene scene = build_scene(own.scene, seed);
    const auto walkable = check_walkable(own.route, scene, BodySize{});
    EXPECT_TRUE(walkable) << name << " seed " << seed << ": " << walkable.error().message;
    const double duration = nominal_duration(own.route);
    EXPECT_GT(duration, 45.0) << name << " seed " << seed;
    EXPECT_LT(duration, 320.0) << name << " seed " << seed;
    EXPECT_LT(std::ranges::count_if(scene.solids, &Solid::collides), 50) << seed;
  }
}

TEST(RandomScenarios, EveryCorridorBuilds) { expect_every_seed_builds("random_corridor"); }
TEST(RandomScenarios, EveryGarageBuilds) { expect_every_seed_builds("random_garage"); }

TEST(RandomScenarios, SeedsToChooseOnCoverTheSpace) {
  const Scenario scenario =
      load_scenario(find_scenario("random_corridor", kFolder).value(), {}).value();
  std::map<std::string, int> counts;
  double narrowest = 10.0;
  double widest = 0.0;
  for (std::uint64_t seed = 1; seed <= 200; ++seed) {
    const Scenario own = scenario_of_seed(scenario, seed);
    const double first = number(own, "scene.corridor.bends.0.angle_deg");
    const double second = number(own, "scene.corridor.bends.1.angle_deg");
    ++counts[fmt::format("{} bends", (first > 0.0) + (second > 0.0))];
    ++counts[number(own, "scene.ramp.grade") > 0.0 ? "ramp" : "level"];
    ++counts[fmt::format("{} people", drawn(own, "scene.people.count"))];
    ++counts["ends " + drawn(own, "scene.corridor.end_walls")];
    ++counts["doors " + drawn(own, "scene.corridor.doors.sides")];
    ++counts[number(own, "scene.corridor.clutter.density") > 0.0 ? "clutter" : "clear"];
    narrowest = std::min(narrowest, number(own, "scene.corridor.width"));
    widest = std::max(widest, number(own, "scene.corridor.width"));
  }
  ASSERT_EQ(counts.size(), 3U + 2U + 4U + 4U + 5U + 2U);
  for (const auto& [what, count] : counts) EXPECT_GE(count, 15) << what;
  EXPECT_LT(narrowest, 1.3);
  EXPECT_GT(widest, 3.9);
}

TEST(ScenarioDraws, BadEntriesAreErrorsWithFileAndLine) {
  const TemporaryFolder folder;
  const auto message = [&](const std::string& entry) {
    const auto file = folder.path() / "bad.yaml";
    EXPECT_TRUE(write_file_atomically(file, "draw:\n  - {" + entry + "}\n"));
    const auto loaded = load_scenario(file, {});
    return loaded ? std::string() : loaded.error().message;
  };
  const auto fails = [&](const std::string& entry, const std::string& why) {
    const std::string text = message(entry);
    EXPECT_NE(text.find("bad.yaml:2:"), std::string::npos) << entry << ": " << text;
    EXPECT_NE(text.find("draw.0"), std::string::npos) << entry << ": " << text;
    EXPECT_NE(text.find(why), std::string::npos) << entry << ": " << text;
  };
  EXPECT_EQ(message("key: route.speed, min: 0.3, max: 1.0"), "");
  fails("key: route.sped, min: 0.3, max: 1.0", "did you mean 'route.speed'");
  fails("key: route.speed, min: 1.0, max: 0.3", "expected less than max");
  fails("key: route.speed, min: 0.3, max: 2.0", "route.speed");
  fails("key: lidar.range_max, min: 0.0, max: 2.0, scale: log", "more than 0");
  fails("key: scene.people.count, min: 0, max: 3", "integer");
  fails("key: scene.people.count, min: 0.5, max: 3, integer: true", "whole numbers");
  fails("key: scene.kind, min: 0, max: 3", "only numbers have ranges");
  fails("key: scene.kind, values: [corridor, cave]", "cave");
  fails("key: route.speed, values: [0.5], max: 1.0", "either values or a range");
  fails("key: route.speed, min: 0.3, max: 1.0, when: [scene.kind]", "KEY=VALUE");
  fails("key: route.speed, min: 0.3, max: 1.0, when: [scene.kimd=garage]", "did you mean");
  fails("key: route.speed, min: 0.3, max: 1.0, when: [scene.kind>=3]", "numbers on both sides");
  fails("key: route.speed, min: 0.3, max: 1.0, when: [route.speed<=1]", "drawn later");
}

TEST(ScenarioDraws, ARobotKeepsItsDrawsAndTheSceneIsOfTheRun) {
  Scenario scenario = drawing(
      {range("leg_odometry.joint_stiffness", 80.0, 2000.0), range("route.speed", 0.3, 1.0)});
  const Scenario own = scenario_of_seed(scenario, 5);
  scenario.simulation.robot_seed = 5;
  EXPECT_EQ(scenario_of_seed(scenario, 5).drawn, own.drawn);
  const Scenario again = scenario_of_seed(scenario, 6);
  EXPECT_EQ(drawn(again, "leg_odometry.joint_stiffness"),
            drawn(own, "leg_odometry.joint_stiffness"));
  EXPECT_NE(drawn(again, "route.speed"), drawn(own, "route.speed"));
}

TEST(ScenarioDraws, SeedsForReportingAreNotChosenOn) {
  const Scenario random = drawing({range("route.speed", 0.3, 1.0)});
  const Scenario fixed = default_scenario({}).value();
  for (const std::uint64_t seed : {2001, 2200, 2400}) {
    const auto checked = check_seeds_to_choose_on(random, {{1, seed}});
    ASSERT_FALSE(checked);
    EXPECT_NE(checked.error().message.find(random.name), std::string::npos);
    EXPECT_NE(checked.error().message.find(std::to_string(seed)), std::string::npos);
    EXPECT_TRUE(check_seeds_to_choose_on(fixed, {{seed}}));
  }
  EXPECT_TRUE(check_seeds_to_choose_on(random, {{1, 200, 2000, 2401}}));
}

}  // namespace
}  // namespace aims
