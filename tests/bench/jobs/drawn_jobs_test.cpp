// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <set>

#include "bench/jobs/job.hpp"
#include "bench/jobs/sequence_cache.hpp"

namespace aims {
namespace {

Scenario drawing_speed() {
  Scenario scenario = default_scenario({}).value();
  Draw draw;
  draw.key = "route.speed";
  draw.min = 0.3;
  draw.max = 1.0;
  scenario.draw = {draw};
  return scenario;
}

TEST(DrawnJobs, EachSeedIsItsOwnSequenceDrawnOrNot) {
  const Scenario scenario = drawing_speed();
  std::set<std::string> sequences;
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    const std::string id = SequenceCache::id_of(scenario, seed);
    EXPECT_EQ(id, SequenceCache::id_of(scenario_of_seed(scenario, seed), seed));
    sequences.insert(id);
  }
  EXPECT_EQ(sequences.size(), 20U);
  EXPECT_NE(SequenceCache::id_of(scenario, 1), SequenceCache::id_of(Scenario(), 1));
}

TEST(DrawnJobs, HoldTheScenarioOfTheirSeed) {
  const auto scenario = std::make_shared<const Scenario>(drawing_speed());
  std::set<double> speeds;
  std::set<std::string> ids;
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    const Job job = make_job(scenario, seed, parse_estimator_spec("leg").value());
    EXPECT_TRUE(job.scenario->draw.empty());
    EXPECT_EQ(job.id, make_job(job.scenario, seed, job.estimator).id);
    speeds.insert(job.scenario->simulation.route.speed);
    ids.insert(job.id);
  }
  EXPECT_EQ(speeds.size(), 5U);
  EXPECT_EQ(ids.size(), 5U);
}

}  // namespace
}  // namespace aims
