// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include "bench/scoring/run_failure.hpp"

namespace aims {
namespace {

/// A run in which `mine` has that outcome, and `good` succeeds.
RunRecord run_of(std::uint64_t seed, const char* reason, Json at) {
  RunRecord run{seed, {}};
  run.scores["truth"]["start_s"] = 1.0;
  run.scores["estimators"]["good"] = {{"success", true}, {"diverged_reason", ""}};
  run.scores["estimators"]["mine"] = {
      {"success", false}, {"diverged_reason", reason}, {"diverged_at_s", std::move(at)}};
  return run;
}

TEST(FailureReasons, SeveralRunsNameEachReasonAndItsTimes) {
  const std::vector<RunRecord> runs = {run_of(1, "gap", 11.0), run_of(2, "gap", 13.5),
                                       run_of(3, "error_limit", 5.0)};
  EXPECT_EQ(failure_lines(runs),
            (std::vector<std::string>{
                "mine on 1 of 3 seeds: error beyond the limit of a success, at 4.0 s",
                "mine on 2 of 3 seeds: gap: no poses for too long, at 10.0 to 12.5 s"}));
}

TEST(FailureReasons, RunsThatFailedByAnErrorAreOfTheRunsThatThereAre) {
  std::vector<RunRecord> runs = {run_of(1, "gap", 11.0), run_of(2, "gap", 13.5)};
  runs[1].scores["estimators"].erase("mine");
  runs[1].scores["failures"] = {{{"estimator", "mine"}, {"message", "boom"}}};
  EXPECT_EQ(
      failure_lines(runs),
      std::vector<std::string>{"mine on 1 of 2 seeds: gap: no poses for too long, at 10.0 s"});
}

TEST(FailureReasons, ASingleRunNamesOnlyWhatItsTableLacks) {
  const std::vector<RunRecord> late = {run_of(1, "starts_late", 1.0)};
  EXPECT_EQ(failure_lines(late),
            std::vector<std::string>{"mine: starts late: no poses near the start"});
  const std::vector<RunRecord> wrong = {run_of(1, "error_limit", 9.0)};
  EXPECT_TRUE(failure_lines(wrong).empty());
  std::vector<RunRecord> stopped = wrong;
  stopped[0].scores["estimators"]["mine"]["partial"] = true;
  EXPECT_EQ(failure_lines(stopped),
            std::vector<std::string>{"mine: error beyond the limit of a success, at 8.0 s; poses "
                                     "are missing, too"});
  EXPECT_TRUE(failure_lines({}).empty());
}

}  // namespace
}  // namespace aims
