// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>

#include "bench/jobs/stored_results.hpp"
#include "bench/scoring/trajectory_scoring.hpp"
#include "bench/scoring/trajectory_summary.hpp"
#include "render/results/pictures.hpp"
#include "tests/support/temporary_folder.hpp"

namespace aims {
namespace {

constexpr double kEnd = 60.0;  ///< [s]

Trajectory sampled(double step, const std::function<Pose(double)>& motion) {
  Trajectory trajectory;
  for (int i = 0; i <= std::lround(kEnd / step); ++i) {
    trajectory.push_back({from_seconds(i * step), motion(i * step)});
  }
  return trajectory;
}

/// Along x at 1 m/s.
Pose straight(double t) { return {Eigen::Quaterniond::Identity(), {t, 0.0, 0.3}}; }

/// A circle of radius 10 m, once around.
Pose circle(double t) {
  const double angle = 2.0 * M_PI * t / kEnd;
  return {yaw_rotation(angle + M_PI / 2.0), {10.0 * std::cos(angle), 10.0 * std::sin(angle), 0.3}};
}

SourcedTrajectory named(const std::string& name, Trajectory trajectory) {
  return {name, name + ".tum", "TUM", std::move(trajectory)};
}

ScoringInput input_of(const std::function<Pose(double)>& truth) {
  ScoringInput input;
  input.truth = named("truth", sampled(0.01, truth));
  input.segments = {{"a-b", from_seconds(5.0), from_seconds(25.0)}};
  return input;
}

bool says(const std::vector<std::string>& notes, const std::string& words) {
  return std::any_of(notes.begin(), notes.end(), [&words](const std::string& note) {
    return note.find(words) != std::string::npos;
  });
}

TEST(TrajectoryScoring, AScaledStraightLineHasTheErrorsOfItsFormula) {
  ScoringInput input = input_of(straight);
  input.estimates.push_back(named(
      "long", sampled(0.1, [](double t) {
        return Pose{yaw_rotation(1.0), yaw_rotation(1.0) * Eigen::Vector3d(1.02 * t, 0.0, 7.0)};
      })));
  const auto result = score_trajectories(input);
  ASSERT_TRUE(result) << result.error().message;
  const Scores& scores = result->estimates[0].scores;
  EXPECT_NEAR(*scores.m_list_percent, 2.0, 1e-9);
  EXPECT_NEAR(scores.m_end->norm_m, 0.02 * kEnd, 1e-9);
  // The error grows as 0.02 t over 601 poses at 10 Hz.
  const double n = 600.0;
  EXPECT_NEAR(*scores.ate_m, 0.02 * 0.1 * std::sqrt(n * (2.0 * n + 1.0) / 6.0), 1e-9);
  // With the best translation what is left is the spread about the mean.
  EXPECT_NEAR(*scores.ate_yaw_m, 0.02 * 0.1 * std::sqrt(n * (n + 2.0) / 12.0), 1e-9);
  EXPECT_EQ(scores.poses_compared, 601);
  EXPECT_EQ(result->estimates[0].median_stamp_difference_s, 0.0);
  const Pose& last = result->estimates[0].in_truth_frame.back().pose;
  EXPECT_TRUE(last.translation.isApprox(Eigen::Vector3d(61.2, 0.0, 0.3), 1e-9));
}

TEST(TrajectoryScoring, StraightMotionSaysThatEvoGivesNoSe3) {
  ScoringInput input = input_of(straight);
  input.estimates.push_back(named("mine", sampled(0.1, straight)));
  const auto result = score_trajectories(input);
  ASSERT_TRUE(result);
  EXPECT_EQ(result->estimates[0].scores.se3_spread, PositionSpread::kLine);
  EXPECT_TRUE(says(result->notes, "mine: too straight"));
  EXPECT_TRUE(says(result->notes, "the rotation about their line from the first pose"));
  const TextTable table = trajectory_score_table(*result);
  const auto column = std::ranges::find(table.header, "ATE SE(3) m") - table.header.begin();
  EXPECT_NE(table.rows[0].at(static_cast<std::size_t>(column)).find("line"), std::string::npos);
  const Json record = record_of(*result).scores;
  EXPECT_EQ(record["estimators"]["mine"]["alignment"]["se3"], "line");
}

TEST(TrajectoryScoring, MotionInThePlaneNeedsNoFallback) {
  ScoringInput input = input_of(circle);
  input.estimates.push_back(named("mine", sampled(0.1, circle)));
  const auto result = score_trajectories(input);
  ASSERT_TRUE(result);
  EXPECT_EQ(result->estimates[0].scores.se3_spread, PositionSpread::kFull);
  EXPECT_TRUE(result->notes.empty()) << result->notes.front();
}

TEST(TrajectoryScoring, StampsThatDoNotOverlapAreAnErrorWithBothSpans) {
  ScoringInput input = input_of(circle);
  Trajectory late = sampled(0.1, circle);
  for (StampedPose& each : late) each.stamp += 1'600'000'000 * kSecond;
  input.estimates.push_back(named("late", late));
  const auto result = score_trajectories(input);
  ASSERT_FALSE(result);
  for (const char* part : {"late.tum", "1600000000.000 to 1600000060.000 s", "0.000 to 60.000 s",
                           "clock offset", "--time-offset -1600000000.000000000"}) {
    EXPECT_NE(result.error().message.find(part), std::string::npos) << result.error().message;
  }
}

TEST(TrajectoryScoring, PoorDataIsCountedAndSaid) {
  ScoringInput input = input_of(circle);
  Trajectory poor = sampled(0.1, circle);
  poor[50].pose.translation.x() = std::numeric_limits<double>::quiet_NaN();
  poor[60].stamp = poor[59].stamp;
  input.estimates.push_back(named("poor", poor));
  const auto result = score_trajectories(input);
  ASSERT_TRUE(result) << result.error().message;
  EXPECT_EQ(result->estimates[0].scores.poses_invalid, 2);
  EXPECT_EQ(result->estimates[0].scores.failure_reason, FailureReason::kInvalid);
  EXPECT_TRUE(says(result->notes, "poor: 2 of 601 poses left out"));
}

TEST(TrajectoryScoring, MapCoordinatesLoseNoPrecision) {
  ScoringInput input = input_of(circle);
  const Eigen::Vector3d origin(5.4e5, 5.3e6, 400.0);
  for (StampedPose& each : input.truth.trajectory) each.pose.translation += origin;
  input.estimates.push_back(named("mine", sampled(0.1, circle)));
  const auto result = score_trajectories(input);
  ASSERT_TRUE(result) << result.error().message;
  EXPECT_TRUE(result->estimates[0].scores.success);
  EXPECT_LT(*result->estimates[0].scores.ate_m, 1e-6);
  EXPECT_TRUE(says(result->notes, "truth: starts 5327 km from its origin"));
}

TEST(TrajectoryScoring, ALongGapOfTheTruthIsSaid) {
  ScoringInput input = input_of(circle);
  auto& truth = input.truth.trajectory;
  truth.erase(truth.begin() + 1000, truth.begin() + 1150);
  input.estimates.push_back(named("mine", sampled(0.1, circle)));
  auto result = score_trajectories(input);
  ASSERT_TRUE(result);
  EXPECT_TRUE(says(result->notes, "truth: no pose for up to 1.5 s"));
  truth.erase(truth.begin() + 1000, truth.begin() + 1150);
  result = score_trajectories(input);
  ASSERT_TRUE(result);
  EXPECT_TRUE(says(result->notes, "truth: 1 gap of more than 2 s"));
}

TEST(TrajectoryScoring, WithoutReferencePointsThereIsNoMList) {
  ScoringInput input = input_of(circle);
  input.segments.clear();
  input.estimates.push_back(named("mine", sampled(0.1, circle)));
  const auto result = score_trajectories(input);
  ASSERT_TRUE(result);
  EXPECT_FALSE(result->estimates[0].scores.m_list_percent);
  EXPECT_TRUE(says(result->notes, "no reference points: no M_list"));
}

TEST(TrajectorySummary, TheBestOfThoseThatDidNotDivergeCarriesTheStar) {
  ScoringInput input = input_of(straight);
  const auto scaled = [](double scale) {
    return [scale](double t) { return straight(scale * t); };
  };
  input.estimates = {named("good", sampled(0.1, scaled(1.01))),
                     named("fair", sampled(0.1, scaled(1.03))),
                     named("quits", sampled(0.1, straight))};
  input.estimates[2].trajectory.resize(100);
  const auto result = score_trajectories(input);
  ASSERT_TRUE(result);
  const TextTable table = trajectory_score_table(*result);
  EXPECT_EQ(table.rows[0][2], "0.347*") << "ATE of the shorter error";
  EXPECT_EQ(table.rows[1][2].find('*'), std::string::npos);
  EXPECT_EQ(table.rows[2][2], "0.000 part") << "exact, but it quits";
  EXPECT_EQ(table.rows[2][table.rows[2].size() - 2], "ends_early at 9.9 s");
  EXPECT_EQ(table.rows[2].back(), "no") << "of 1 %";
}

TEST(TrajectorySummary, ItsFolderReadsBackAsResults) {
  const TemporaryFolder folder;
  ScoringInput input = input_of(circle);
  input.estimates.push_back(named("mine", sampled(0.1, circle)));
  const auto scores = score_trajectories(input);
  ASSERT_TRUE(scores);
  ASSERT_TRUE(write_trajectory_scores(*scores, folder.path()));
  ASSERT_TRUE(draw_trajectory_pictures(*scores, folder.path()));
  for (const char* file :
       {"scores.json", "scores.csv", "scores.md", "trajectories.png", "errors.png"}) {
    EXPECT_TRUE(std::filesystem::exists(folder.path() / file)) << file;
  }
  const auto results = read_results(folder.path());
  ASSERT_TRUE(results) << results.error().message;
  const auto value = find_score(results->at("truth").front(), "mine", "m_list_percent.a-b");
  ASSERT_TRUE(value);
  EXPECT_NEAR(*value, 0.0, 1e-9);
}

}  // namespace
}  // namespace aims
