// SPDX-License-Identifier: BSD-3-Clause
#include "harness/gates.hpp"

#include <gtest/gtest.h>

namespace aims {
namespace {

RunRecord record() {
  RunRecord run;
  run.seed = 7;
  run.scores["estimators"]["aims"] = {
      {"m_end_m", 0.15}, {"ate_m", nullptr}, {"m_list_percent", {{"a-b", 0.07}}}};
  return run;
}

Scenario expecting(const std::string& estimator, const std::string& score, double max) {
  Scenario scenario;
  scenario.name = "corridor";
  scenario.expect = {{estimator, score, max}};
  return scenario;
}

TEST(Gates, HoldWhenTheScoreIsWithinItsLimit) {
  EXPECT_TRUE(failed_gates(expecting("aims", "m_end_m", 0.2), record()).empty());
  EXPECT_TRUE(failed_gates(expecting("aims", "m_list_percent.a-b", 0.07), record()).empty());
}

TEST(Gates, FailWithScenarioSeedFigureAndLimit) {
  const auto failures = failed_gates(expecting("aims", "m_end_m", 0.1), record());
  ASSERT_EQ(failures.size(), 1U);
  EXPECT_EQ(text_of(failures.front()),
            "corridor seed 7: aims m_end_m = 0.15, expected at most 0.1");
}

TEST(Gates, FailWhereThereIsNoValue) {
  EXPECT_EQ(failed_gates(expecting("aims", "ate_m", 0.1), record()).size(), 1U);
  EXPECT_EQ(failed_gates(expecting("aims", "no_such_score", 0.1), record()).size(), 1U);
}

TEST(Gates, DoNotCountForEstimatorsThatDidNotRun) {
  Scenario scenario = expecting("lio", "m_end_m", 0.1);
  scenario.estimators = {"aims"};
  EXPECT_TRUE(failed_gates(scenario, record()).empty());
}

}  // namespace
}  // namespace aims
