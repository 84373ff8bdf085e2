// SPDX-License-Identifier: BSD-3-Clause
// Ranges of keys that are not the estimator's: which they are, and what units they make.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <set>
#include <string>
#include <vector>

#include "bench/jobs/job_runner.hpp"
#include "bench/jobs/job_store.hpp"
#include "bench/tuning/range_key.hpp"
#include "bench/tuning/sweep_plan.hpp"
#include "tests/bench/short_walk.hpp"
#include "tests/support/temporary_folder.hpp"

namespace aims {
namespace {

bool says(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

const std::vector<EstimatorSpec> kAims = {*parse_estimator_spec("aims")};

std::string refusal_of(const std::string& text) {
  const auto ranges = parse_ranges(std::vector{text}, {});
  if (!ranges) return ranges.error().message;
  const auto checked = check_ranges(*ranges, testing::short_walk(), kAims);
  return checked ? "accepted" : checked.error().message;
}

TEST(RangeKey, IsTheEstimatorsWithAndWithoutItsGroup) {
  for (const char* given :
       {"degeneracy.eta", "estimators.aims.degeneracy.eta", "estimators.*.degeneracy.eta"}) {
    const auto key = range_key(given);
    ASSERT_TRUE(key);
    EXPECT_EQ(key->name, "degeneracy.eta");
    EXPECT_TRUE(key->of_estimator);
  }
}

TEST(RangeKey, IsTheScenariosWhereTheEstimatorHasNone) {
  for (const char* given : {"links.lidar.loss", "scenario.links.lidar.loss"}) {
    const auto key = range_key(given);
    ASSERT_TRUE(key);
    EXPECT_EQ(key->name, "links.lidar.loss");
    EXPECT_FALSE(key->of_estimator);
  }
}

TEST(RangeKey, ThatBothHaveNeedsAPrefix) {
  const auto bare = range_key("imu.gyro_bias_walk");
  ASSERT_FALSE(bare);
  EXPECT_TRUE(says(bare.error().message, "'estimators.*.imu.gyro_bias_walk'"));
  EXPECT_TRUE(says(bare.error().message, "'scenario.imu.gyro_bias_walk'"));
  EXPECT_EQ(range_key("estimators.*.imu.gyro_bias_walk")->name, "imu.gyro_bias_walk");
  const auto both =
      parse_ranges(std::vector<std::string>{"estimators.*.imu.gyro_bias_walk=0.0001:0.001:2",
                                            "scenario.imu.gyro_bias_walk=0:0.001:2"},
                   {});
  ASSERT_TRUE(both);
  EXPECT_TRUE(check_ranges(*both, testing::short_walk(), kAims));
  EXPECT_EQ(full_key((*both)[0]), "estimators.*.imu.gyro_bias_walk");
  EXPECT_EQ(full_key((*both)[1]), "imu.gyro_bias_walk");
}

TEST(RangeKey, IsHeldAgainstTheScenario) {
  EXPECT_EQ(refusal_of("links.leg_odometry.loss=0:0.5:6"), "accepted");
  EXPECT_EQ(refusal_of("lidar.range_sigma=0:0.05:3"), "accepted");
  EXPECT_EQ(refusal_of("scoring.max_error_offset=0.5:2:3"), "accepted");
  EXPECT_EQ(refusal_of("route.points.1.x=0.5:2:3"), "accepted");
  EXPECT_TRUE(says(refusal_of("route.points.7.x=0.5:2:3"), "no entry 7"));
  EXPECT_TRUE(
      says(refusal_of("links.leg_odometry.los=0:0.5:6"), "did you mean 'links.leg_odometry.loss'"));
  EXPECT_TRUE(says(refusal_of("degeneracy.etta=0:6:3"), "did you mean 'degeneracy.eta'"));
  EXPECT_TRUE(says(refusal_of("links.leg_odometry.loss=0:7:3"), "expected a number in [0, 1"));
  EXPECT_TRUE(says(refusal_of("lidar.columns=log(0.5,300,3)"), "expected an integer"));
  EXPECT_TRUE(says(refusal_of("leg_odometry.foot_model=0:1:2"), "only numbers"));
  EXPECT_TRUE(says(refusal_of("seed=1:5:5"), "seeds are listed by 'seeds'"));
  EXPECT_TRUE(says(refusal_of("level=1:5:5"), "decides no number of a run"));
  EXPECT_TRUE(says(refusal_of("ground_constraint.sigma_height=1:5:5"),
                   "has no effect on aims: ground_constraint.enabled is false"));
  EXPECT_TRUE(says(refusal_of("estimators.lio.lidar.correlated_points=1:9:5"),
                   "a key of lio, but aims is varied"));
}

SweepPlan plan_over(std::vector<std::string> over) {
  SweepPlan plan;
  plan.scenarios = {AIMS_SCENARIOS "/paper/corridor.yaml"};
  plan.estimators = {"aims", "leg"};
  plan.seeds = "1-2";
  plan.params = std::move(over);
  return plan;
}

std::vector<Job> units_of(const SweepPlan& plan) {
  auto units = plan_jobs(plan, AIMS_SCENARIOS);
  EXPECT_TRUE(units) << units.error().message;
  return units.value_or(std::vector<Job>());
}

/// Names of the units' walks, in order; the same walk once where units on it stand together.
std::vector<std::string> walks_of(const std::vector<Job>& units) {
  std::vector<std::string> walks;
  for (const Job& unit : units) {
    const std::string id = SequenceCache::id_of(*unit.scenario, unit.seed);
    if (walks.empty() || walks.back() != id) walks.push_back(id);
  }
  return walks;
}

TEST(ScenarioRange, OfTheSimulationMakesAWalkPerValueThatItsUnitsShare) {
  const auto units = units_of(plan_over({"queue.lag=0:0.1:3", "links.leg_odometry.loss=0:0.5:3"}));
  EXPECT_EQ(units.size(), 2U * (3U * 3U + 1U) * 2U) << "with the defaults";
  const auto walks = walks_of(units);
  EXPECT_EQ(walks.size(), (3U + 1U) * 2U) << "those on one walk stand together";
  EXPECT_EQ(std::set(walks.begin(), walks.end()).size(), walks.size());
  for (const Job& unit : units) {
    if (unit.scenario->simulation.links.leg_odometry.loss == 0.05) continue;  // the defaults
    ASSERT_EQ(unit.scenario_settings.size(), 1U);
    EXPECT_EQ(unit.scenario_settings[0].key, "links.leg_odometry.loss");
    EXPECT_EQ(unit.scenario_settings[0].default_value, "0.05");
    EXPECT_EQ(unit.scenario_settings[0].value,
              fmt::format("{}", unit.scenario->simulation.links.leg_odometry.loss));
    EXPECT_EQ(unit.id, make_job(unit.scenario, unit.seed, unit.estimator).id);
  }
}

TEST(ScenarioRange, OfTheScoringKeepsTheWalk) {
  const auto units = units_of(plan_over({"scoring.max_error_offset=0.5:2:4"}));
  EXPECT_EQ(units.size(), 4U * 2U * 2U);
  EXPECT_EQ(walks_of(units).size(), 2U) << "one per seed";
}

TEST(ScenarioRange, RoundsWholeNumbersAndMakesNoUnitTwice) {
  SweepPlan plan = plan_over({"lidar.rings=15:17:9"});
  EXPECT_EQ(units_of(plan).size(), 3U * 2U * 2U);
  plan.params = {"links.leg_odometry.loss=0:0.1:3"};
  EXPECT_EQ(units_of(plan).size(), 3U * 2U * 2U) << "0.05 is what the scenario has";
}

TEST(ScenarioRange, IsInTheUnitsTextAndFile) {
  const auto units = units_of(plan_over({"links.leg_odometry.loss=0:0.5:2"}));
  const Job& unit = units.back();
  EXPECT_EQ(text_of(unit), "corridor seed 2 leg+links.leg_odometry.loss=0.5");
  const Json json = job_json(unit, {});
  EXPECT_EQ(json["settings"]["links.leg_odometry.loss"], "0.5");
  EXPECT_EQ(json["defaults"]["links.leg_odometry.loss"], "0.05");
}

TEST(ScenarioRange, IsSwept) {
  const TemporaryFolder folder;
  JobOptions options;
  options.out = folder.path() / "sweep";
  options.cache = folder.path() / "sequences";
  std::vector<Job> units;
  for (const char* loss : {"0", "0.9"}) {
    Scenario scenario = testing::short_walk();
    ASSERT_TRUE(assign(fields_of(scenario), "links.leg_odometry.loss", loss));
    for (const char* spec : {"leg", "leg+max_speed=4"}) {
      units.push_back(make_job(testing::shared(scenario), 1, parse_estimator_spec(spec).value()));
      units.back().scenario_settings = {{"links.leg_odometry.loss", loss, "0.05"}};
    }
  }
  const auto run = run_jobs({units}, options, [](const JobProgress&) { return true; });
  ASSERT_TRUE(run) << run.error().message;
  EXPECT_EQ(run->done, 4U);
  EXPECT_EQ(run->sequences, 2U) << "a sequence per value, for both of its jobs";
  const auto listed = JobStore(options.out).listed();
  ASSERT_TRUE(listed);
  EXPECT_EQ(listed->back().estimator, "leg+max_speed=4+links.leg_odometry.loss=0.9");
}

// The defaults of the scenarios would be different points under one name.
TEST(ScenarioRange, IsRefusedWhereScenariosHaveOtherDefaults) {
  SweepPlan plan;
  plan.scenarios = {"corridor", "severity_5"};
  plan.estimators = {"leg"};
  plan.params = {"lidar.range_max=30:100:2"};
  const auto refused = plan_jobs(plan, AIMS_SCENARIOS);
  ASSERT_FALSE(refused);
  EXPECT_TRUE(says(refused.error().message,
                   "lidar.range_max is 30 there and 100 in corridor; expected the same default "
                   "values in all scenarios, e.g. by --set lidar.range_max=100"))
      << refused.error().message;
  plan.set = {"lidar.range_max=100"};
  EXPECT_TRUE(plan_jobs(plan, AIMS_SCENARIOS));
}

// Reports take an estimator's defaults from the program and the plan, not from a scenario.
TEST(ScenarioRange, IsRefusedWhereAScenarioSetsTheEstimatorAnew) {
  const TemporaryFolder folder;
  const auto file = folder.path() / "own.yaml";
  std::ofstream(file) << "base: " AIMS_SCENARIOS
                         "/severity/severity_3.yaml\nname: own\n"
                         "estimators: {aims: {degeneracy: {eta: 6}}}\n";
  SweepPlan plan;
  plan.scenarios = {file.string()};
  plan.estimators = {"b=aims+degeneracy.kappa=20", "aims"};
  plan.params = {"degeneracy.eta=1:6:2"};
  const auto refused = plan_jobs(plan, AIMS_SCENARIOS);
  ASSERT_FALSE(refused);
  EXPECT_TRUE(says(refused.error().message, "own: degeneracy.eta is 6 there and 3 in the program"))
      << refused.error().message;
  plan.set = {"estimators.aims.degeneracy.eta=6"};
  const auto accepted = plan_jobs(plan, AIMS_SCENARIOS);
  EXPECT_TRUE(accepted) << accepted.error().message;
}

}  // namespace
}  // namespace aims
