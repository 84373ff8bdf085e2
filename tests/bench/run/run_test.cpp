// SPDX-License-Identifier: BSD-3-Clause
#include "bench/run/run.hpp"

#include <gtest/gtest.h>

#include "core/files/tum.hpp"
#include "tests/bench/run/short_walk.hpp"

namespace aims {
namespace {

using test::keep_going;

/// A few seconds of the corridor: stand, walk three metres, turn, walk back.
Scenario there_and_back() {
  Scenario scenario;
  scenario.name = "there_and_back";
  scenario.simulation.scene.corridor.length = 10.0;
  scenario.simulation.route.points = {{"a", 0.0, 0.0}, {"b", 3.0, 0.0}, {"a", 0.0, 0.0}};
  scenario.simulation.route.stand_before = 2.5;
  return scenario;
}

TEST(Run, GivesTheSameBytesOnOneThreadAndOnTwo) {
  const auto one = run(there_and_back(), {.seed = 3, .jobs = 1}, keep_going);
  const auto two = run(there_and_back(), {.seed = 3, .jobs = 2}, keep_going);
  ASSERT_TRUE(one && two);
  EXPECT_EQ(tum_text(one->truth_trajectory), tum_text(two->truth_trajectory));
  ASSERT_EQ(one->estimators.size(), 6U);
  for (std::size_t i = 0; i < one->estimators.size(); ++i) {
    EXPECT_EQ(tum_text(one->estimators[i].result.trajectory),
              tum_text(two->estimators[i].result.trajectory))
        << one->estimators[i].name;
  }
}

TEST(Run, ScoresEveryEstimatorOnAWalkThatEndsWhereItBegan) {
  const auto result = run(there_and_back(), {.seed = 1, .jobs = 2}, keep_going);
  ASSERT_TRUE(result) << result.error().message;
  EXPECT_TRUE(result->complete);
  EXPECT_FALSE(result->truth.fell);
  EXPECT_EQ(result->truth.waypoint_times.size(), 3U);
  for (const EstimatorOutcome& outcome : result->estimators) {
    EXPECT_TRUE(outcome.scores.success) << outcome.name;
    EXPECT_EQ(outcome.scan_times_ms.size(), outcome.result.trajectory.size()) << outcome.name;
  }
}

TEST(Run, EndsEarlyWithWhatThereIsWhenTheObserverSaysSo) {
  const auto result = run(there_and_back(), {.seed = 1, .jobs = 2},
                          [](const Progress& progress) { return progress.simulated_s < 5.0; });
  ASSERT_TRUE(result);
  EXPECT_FALSE(result->complete);
  EXPECT_GT(result->simulated_s, 4.0);
  EXPECT_LT(result->simulated_s, 8.0);
  EXPECT_GT(result->estimators.front().result.trajectory.size(), 10U);
}

TEST(Run, RefusesAScenarioThatStartsInAWall) {
  Scenario scenario = there_and_back();
  scenario.simulation.route.points = {{"a", 0.0, 1.1}, {"b", 3.0, 1.1}};
  EXPECT_FALSE(run(scenario, {.seed = 1, .jobs = 1}, keep_going));
}

TEST(Run, RefusesARouteWithoutLength) {
  Scenario scenario = there_and_back();
  scenario.simulation.route.points = {{"a", 1.0, 0.0}, {"b", 1.0, 0.0}};
  EXPECT_FALSE(run(scenario, {.seed = 1, .jobs = 1}, keep_going));
}

}  // namespace
}  // namespace aims
