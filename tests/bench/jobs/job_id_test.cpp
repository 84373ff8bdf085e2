// SPDX-License-Identifier: BSD-3-Clause
#include "bench/jobs/job_id.hpp"

#include <gtest/gtest.h>

#include "tests/bench/short_walk.hpp"
#include "tests/support/estimator_settings.hpp"

namespace aims {
namespace {

using testing::short_walk;

TEST(JobId, DependsOnWhatDecidesAResultAndOnNothingElse) {
  const Scenario scenario = short_walk();
  const std::string id = job_id(scenario, 1, "aims");
  EXPECT_EQ(id.size(), 16U);
  EXPECT_NE(id, job_id(scenario, 2, "aims"));
  EXPECT_NE(id, job_id(scenario, 1, "leg"));
  Scenario same = scenario;
  same.name = "b";
  same.description = "other words";
  same.tags = {"more"};
  same.level = 7.0;
  same.run = {"aims"};
  same.expect = {{"aims", "ate_m", 1.0}};
  same.file = "/elsewhere/b.yaml";
  EXPECT_EQ(id, job_id(same, 1, "aims"));
  same.estimators = test::with(same.estimators, "aims.degeneracy.eta", "4");
  EXPECT_NE(id, job_id(same, 1, "aims"));
  same = scenario;
  same.scoring.max_error_offset += 1.0;
  EXPECT_NE(id, job_id(same, 1, "aims"));
  same = scenario;
  same.simulation.lidar.range_max = 6.0;
  EXPECT_NE(id, job_id(same, 1, "aims"));
}

}  // namespace
}  // namespace aims
