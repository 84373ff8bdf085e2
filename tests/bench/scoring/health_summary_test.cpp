// SPDX-License-Identifier: BSD-3-Clause
#include "bench/scoring/health_summary.hpp"

#include <gtest/gtest.h>

namespace aims {
namespace {

/// Starts, is healthy from 1 s, without legs from 5 s, and without LiDAR too from 7 to 10 s.
std::vector<HealthRow> rows() {
  return {{0, HealthState::kStarting, {"no IMU data"}, 0.0},
          {1 * kSecond, HealthState::kHealthy, {}, 0.01},
          {5 * kSecond, HealthState::kDegraded, {"no leg odometry"}, 0.02},
          {7 * kSecond, HealthState::kInvalid, {"no LiDAR scans", "no leg odometry"}, 0.5},
          {10 * kSecond, HealthState::kHealthy, {}, 0.01}};
}

TEST(HealthSummary, CountsTheTimeOfEachStateAndReasonAfterTheStart) {
  const HealthSummary summary = health_summary(rows());
  EXPECT_EQ(summary.worst, HealthState::kInvalid);
  EXPECT_DOUBLE_EQ(summary.healthy_s, 4.0);
  EXPECT_DOUBLE_EQ(summary.degraded_s, 2.0);
  EXPECT_DOUBLE_EQ(summary.invalid_s, 3.0);
  EXPECT_DOUBLE_EQ(summary.reasons.at("no leg odometry"), 5.0);
  EXPECT_DOUBLE_EQ(summary.reasons.at("no LiDAR scans"), 3.0);
  EXPECT_FALSE(summary.reasons.contains("no IMU data"));
}

TEST(HealthSummary, TextNamesStatesAndTheLongestReasonFirst) {
  EXPECT_EQ(text_of(health_summary(rows())),
            "invalid for 3.0 s, degraded for 2.0 s (no leg odometry 5.0 s, no LiDAR scans 3.0 s)");
  HealthSummary warned = health_summary(rows());
  warned.of_recording = {"no foot in contact", "feet disagree"};
  EXPECT_EQ(text_of(warned),
            "invalid for 3.0 s, degraded for 2.0 s (no foot in contact, feet disagree; "
            "no leg odometry 5.0 s, no LiDAR scans 3.0 s)");
  EXPECT_EQ(text_of(health_summary({{0, HealthState::kHealthy, {}, 0.0}})), "");
  EXPECT_EQ(text_of(health_summary({{0, HealthState::kStarting, {}, 0.0}})), "never started");
  EXPECT_EQ(text_of(health_summary({})), "");  // a system that does not judge itself
}

TEST(HealthSummary, OfTooShortARecordingSaysThatAlone) {
  HealthSummary summary = health_summary({{0, HealthState::kStarting, {}, 0.0}});
  summary.too_short = "too short: 3 scans over 0.3 s";
  EXPECT_EQ(text_of(summary), "too short: 3 scans over 0.3 s");
}

TEST(HealthSummary, LinesNameTheEstimatorsThatWereNotHealthy) {
  RunRecord run{3, {}};
  run.scores["estimators"]["lio"]["health"] = health_json(health_summary(rows()));
  run.scores["estimators"]["leg"]["health"] =
      health_json(health_summary({{0, HealthState::kHealthy, {}, 0.0}}));
  run.scores["estimators"]["fast_lio2"]["health"] = health_json(health_summary({}));
  run.scores["estimators"]["older"]["ate_m"] = 0.1;
  EXPECT_EQ(health_lines(run),
            std::vector<std::string>{
                "lio seed 3: invalid for 3.0 s, degraded for 2.0 s (no leg odometry 5.0 s, no "
                "LiDAR scans 3.0 s)"});
}

TEST(HealthSummary, CountsTheHealthyTimeAfterAnInstant) {
  EXPECT_DOUBLE_EQ(healthy_after(rows(), 0), 4.0);
  EXPECT_DOUBLE_EQ(healthy_after(rows(), 2 * kSecond), 3.0);
  EXPECT_DOUBLE_EQ(healthy_after(rows(), 6 * kSecond), 0.0);
  EXPECT_DOUBLE_EQ(healthy_after({}, 0), 0.0);
}

TEST(HealthSummary, LinesNameWhoWasHealthyWhileWrong) {
  RunRecord run{3, {}};
  Json& estimators = run.scores["estimators"];
  const Json healthy = health_json(health_summary({{0, HealthState::kHealthy, {}, 0.0}}));
  for (const char* name : {"briefly", "leg"}) estimators[name]["health"] = healthy;
  estimators["briefly"]["health"]["healthy_while_wrong_s"] = 0.4;
  estimators["leg"]["health"]["healthy_while_wrong_s"] = 98.9;
  estimators["lio"]["health"] = health_json(health_summary(rows()));
  estimators["lio"]["health"]["healthy_while_wrong_s"] = 3.0;
  EXPECT_EQ(health_lines(run),
            (std::vector<std::string>{
                "leg seed 3: healthy for 98.9 s while wrong",
                "lio seed 3: invalid for 3.0 s, degraded for 2.0 s (no leg odometry 5.0 s, no "
                "LiDAR scans 3.0 s); healthy for 3.0 s while wrong"}));
}

TEST(HealthSummary, TableHasARowPerChange) {
  const std::string text = health_table(rows()).text();
  EXPECT_TRUE(text.starts_with("stamp_s,state,reasons,position_sigma_m\n")) << text;
  EXPECT_NE(text.find("7,invalid,no LiDAR scans; no leg odometry,0.5\n"), std::string::npos)
      << text;
}

}  // namespace
}  // namespace aims
