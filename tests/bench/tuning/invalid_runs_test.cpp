// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include "bench/tuning/objective.hpp"

namespace aims {
namespace {

JobResult job_on(const char* end) {
  JobResult job;
  job.scores = {{"success", true}, {"ate_m", 0.2}};
  job.sequence = {{"simulated_s", 1.2}, {"robot", {{"fell", false}, {"end", end}}}};
  return job;
}

TEST(InvalidRunsOfTuning, AreNoScoreAndNoDivergence) {
  const RunScore fallen = run_score(job_on("fell"), "ate_m");
  EXPECT_FALSE(fallen.value);
  EXPECT_FALSE(fallen.diverged);
  EXPECT_EQ(fallen.invalid, "the robot fell at 1.2 s");
  EXPECT_EQ(run_score(job_on("route_done"), "ate_m").value, 0.2);
}

TEST(InvalidRunsOfTuning, AreLeftOutOfTheObjective) {
  Objective objective;
  objective.relative = false;
  const RunScore fallen = {std::nullopt, false, "the robot fell at 1.2 s"};
  const std::vector<RunScore> without = {{0.1}, {0.3}, {0.2, true}};
  const std::vector<RunScore> with = {{0.1}, fallen, {0.3}, {0.2, true}};
  EXPECT_EQ(objective_value(objective, with, {}), objective_value(objective, without, {}));
  EXPECT_FALSE(objective_value(objective, std::vector{fallen}, {}));
}

TEST(InvalidRunsOfTuning, AreCountedPerSequence) {
  const RunScore fallen = {std::nullopt, false, "the robot fell at 1.2 s"};
  ResponseTable table;
  table.cases = {{"corridor", "corridor", 3}, {"garage", "garage", 1}};
  table.runs = {{fallen, {0.1}}, {{0.1}, {0.1}}};
  EXPECT_EQ(left_out_lines(table),
            std::vector<std::string>{"corridor seed 3: 1 of 2 runs are invalid and left out (the "
                                     "robot fell at 1.2 s)"});
}

}  // namespace
}  // namespace aims
