// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <set>

#include "bench/tuning/sweep_plan.hpp"
#include "bench/tuning/tune_plan.hpp"

namespace aims {
namespace {

SweepPlan sweep_of(const char* seeds) {
  SweepPlan plan;
  plan.scenarios = {"random_corridor"};
  plan.seeds = seeds;
  plan.params = {"degeneracy.eta=0:6:2"};
  return plan;
}

TunePlan tune_of(const char* scenario, const char* seeds, const char* held_out) {
  TunePlan plan;
  plan.scenarios = {scenario};
  plan.params = {"degeneracy.eta=0:6"};
  plan.seeds = seeds;
  plan.held_out.seeds = held_out;
  return plan;
}

void expect_refused(const std::string& message, const char* seed) {
  EXPECT_NE(message.find("random_corridor: seed " + std::string(seed)), std::string::npos)
      << message;
  EXPECT_NE(message.find("for reporting only"), std::string::npos) << message;
}

TEST(ReportingSeeds, AreRefusedBySweepsOnScenariosWithDraws) {
  const auto jobs = plan_jobs(sweep_of("1,2001"), AIMS_SCENARIOS);
  ASSERT_FALSE(jobs);
  expect_refused(jobs.error().message, "2001");
  EXPECT_TRUE(plan_jobs(sweep_of("1,200,1201"), AIMS_SCENARIOS));
  SweepPlan fixed = sweep_of("2001");
  fixed.scenarios = {"corridor"};
  EXPECT_TRUE(plan_jobs(fixed, AIMS_SCENARIOS));
}

TEST(ReportingSeeds, AreRefusedByTuningAlsoWhenHeldOut) {
  const auto tuned = tune_task(tune_of("random_corridor", "2150", "1"), AIMS_SCENARIOS);
  ASSERT_FALSE(tuned);
  expect_refused(tuned.error().message, "2150");
  const auto held = tune_task(tune_of("random_corridor", "1-2", "2400"), AIMS_SCENARIOS);
  ASSERT_FALSE(held);
  expect_refused(held.error().message, "2400");
  TunePlan other = tune_of("corridor", "1-2", "2010");
  other.held_out.scenarios = {"random_corridor"};
  const auto held_scenario = tune_task(other, AIMS_SCENARIOS);
  ASSERT_FALSE(held_scenario);
  expect_refused(held_scenario.error().message, "2010");
  EXPECT_TRUE(tune_task(tune_of("random_corridor", "1-2", "3"), AIMS_SCENARIOS));
  EXPECT_TRUE(tune_task(tune_of("corridor", "2001", "2002"), AIMS_SCENARIOS));
}

TEST(DrawnSweep, VariesAKeyInsteadOfDrawingItAndDrawsTheOthers) {
  SweepPlan plan = sweep_of("1-3");
  plan.params = {"links.leg_odometry.loss=0:0.2:2"};
  const auto jobs = plan_jobs(plan, AIMS_SCENARIOS);
  ASSERT_TRUE(jobs) << jobs.error().message;
  ASSERT_EQ(jobs->size(), 9U) << "the scenario as it is on each seed, and two losses";
  std::set<double> losses;
  std::set<double> lengths;
  for (const Job& job : *jobs) {
    EXPECT_TRUE(job.scenario->draw.empty());
    if (job.scenario_settings.empty()) continue;
    losses.insert(job.scenario->simulation.links.leg_odometry.loss);
    lengths.insert(job.scenario->simulation.scene.corridor.length);
    EXPECT_EQ(job.id, make_job(job.scenario, job.seed, job.estimator).id);
  }
  EXPECT_EQ(losses, (std::set<double>{0.0, 0.2}));
  EXPECT_EQ(lengths.size(), 3U) << "one per seed, the same at both losses";
}

}  // namespace
}  // namespace aims
