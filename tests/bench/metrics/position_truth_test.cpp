// SPDX-License-Identifier: BSD-3-Clause
// A truth of positions, of few points, or with gaps.
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "bench/metrics/lever_arm.hpp"
#include "bench/metrics/scores.hpp"
#include "tests/bench/metrics/trajectories.hpp"

namespace aims {
namespace {

/// A figure of eight that climbs, at 1 m/s or so.
Pose eight(double t) {
  const double a = 0.1 * t;
  return {yaw_rotation(2.0 * a), {8.0 * std::sin(a), 5.0 * std::sin(2.0 * a), 0.02 * t}};
}

/// The same path, whose body also rolls and pitches.
Pose swaying_eight(double t) {
  Pose pose = eight(t);
  pose.rotation = pose.rotation * so3_exp({0.3 * std::sin(0.5 * t), 0.2 * std::cos(0.4 * t), 0.0});
  return pose;
}

Trajectory positions_of(Trajectory poses, const Eigen::Vector3d& lever) {
  for (StampedPose& each : poses) {
    each.pose.translation += each.pose.rotation * lever;
    each.pose.rotation.setIdentity();
  }
  return poses;
}

TEST(MovedToPoints, EachStampHasTheMeasuredPointExactly) {
  Trajectory walk, points;
  for (int k = 0; k <= 400; ++k) walk.push_back({k * 100 * kMillisecond, swaying_eight(0.1 * k)});
  // Between two poses of the walk.
  for (int k = 1; k < 8; ++k) {
    const Eigen::Vector3d p(-0.8, 0.3 * k, k % 2 == 0 ? 0.2 : 0.4);
    points.push_back({k * 5 * kSecond + 30 * kMillisecond, {Eigen::Quaterniond::Identity(), p}});
  }
  const Trajectory moved = moved_to_points(walk, points);
  EXPECT_EQ(moved.size(), walk.size() + points.size());
  for (const StampedPose& each : points) {
    const Eigen::Vector3d expected = *pose_at(walk, each.stamp) * each.pose.translation;
    EXPECT_NEAR((pose_at(moved, each.stamp)->translation - expected).norm(), 0.0, 1e-12);
  }
  EXPECT_EQ(moved_to_points(walk, {}).size(), walk.size());
}

/// Smallest RMSE over all headings by brute force, the means of both made equal, as evo's formula
/// sqrt(mean |R p_est + t - p_ref|^2).
double brute_force_ate(const Trajectory& estimate, const Trajectory& truth) {
  Eigen::Vector3d mean_estimate = Eigen::Vector3d::Zero(), mean_truth = Eigen::Vector3d::Zero();
  const auto count = static_cast<double>(estimate.size());
  for (std::size_t i = 0; i < estimate.size(); ++i) {
    mean_estimate += estimate[i].pose.translation / count;
    mean_truth += truth[i].pose.translation / count;
  }
  double best = 1e9;
  for (int k = 0; k < 60000; ++k) {
    const double yaw = 2.0 * std::numbers::pi * k / 60000.0;
    double sum = 0.0;
    for (std::size_t i = 0; i < estimate.size(); i += 1) {
      const Eigen::Vector3d p = estimate[i].pose.translation - mean_estimate;
      const Eigen::Vector3d q = truth[i].pose.translation - mean_truth;
      const double x = std::cos(yaw) * p.x() - std::sin(yaw) * p.y() - q.x();
      const double y = std::sin(yaw) * p.x() + std::cos(yaw) * p.y() - q.y();
      sum += x * x + y * y + (p.z() - q.z()) * (p.z() - q.z());
    }
    best = std::min(best, std::sqrt(sum / count));
  }
  return best;
}

ScoreConfig of_positions() {
  ScoreConfig config;
  config.truth = TruthContent::kPosition;
  return config;
}

TEST(PositionTruth, AlignsByThePathAndHasNoScoresOfAttitude) {
  std::mt19937 random(7);
  std::normal_distribution<double> noise(0.0, 0.3);
  const Trajectory truth = positions_of(test::sampled(0.0, 60.0, 0.5, eight), {0.0, 0.0, 0.0});
  const Pose T_odom_world = {yaw_rotation(2.1), {40.0, -7.0, 3.0}};
  const Trajectory estimate = test::sampled(0.0, 60.0, 0.5, [&](double t) {
    Pose pose = T_odom_world * eight(t);
    pose.translation += Eigen::Vector3d(noise(random), noise(random), noise(random));
    return pose;
  });
  const Scores s = score(estimate, truth, {}, of_positions());
  EXPECT_NEAR(s.ate_yaw_m.value(), brute_force_ate(estimate, truth), 1e-6);
  EXPECT_LE(s.ate_se3_m.value(), s.ate_yaw_m.value());
  EXPECT_FALSE(s.ate_m) << "needs the true heading of the first pose";
  EXPECT_FALSE(s.heading_error_rad);
  EXPECT_FALSE(s.heading_offset_rad);
  EXPECT_FALSE(s.path_errors.all.translation_percent) << "taken in axes of the true body";
  for (const RpeScore& each : s.rpe) EXPECT_FALSE(each.translation_rmse_m);
  EXPECT_TRUE(s.m_end) << "its heading is that of the path";
  EXPECT_EQ(s.coverage, 1.0);
}

TEST(PositionTruth, OfAPerfectEstimateIsASuccessInAnyFrameThoughItsAttitudeIsNone) {
  const Trajectory truth = positions_of(test::sampled(5.0, 65.0, 0.1, eight), {0.0, 0.0, 0.0});
  const Pose T_odom_world = {yaw_rotation(-1.3), {4.0, -7.0, 3.0}};
  const Trajectory estimate =
      test::sampled(5.0, 65.0, 0.1, [&](double t) { return T_odom_world * eight(t); });
  const Scores s = score(estimate, truth, {}, of_positions());
  EXPECT_TRUE(s.success_1_percent);
  EXPECT_NEAR(s.ate_yaw_m.value(), 0.0, 1e-9);
  EXPECT_NEAR(s.m_end.value().norm_m, 0.0, 1e-9);
  // The same truth taken for poses sees the estimate turned by its first heading.
  EXPECT_GT(score(estimate, truth, {}, ScoreConfig()).ate_m.value(), 1.0);
}

TEST(LeverArm, IsFoundFromTheMotionAndTheErrorOfAPrismVanishes) {
  const Eigen::Vector3d lever(0.12, -0.05, 0.41);
  const Pose T_odom_world = {yaw_rotation(0.4), {1.0, 2.0, 0.5}};
  const Trajectory body = test::sampled(0.0, 60.0, 0.1, swaying_eight);
  const Trajectory truth = positions_of(body, lever);
  Trajectory estimate = body;
  for (StampedPose& each : estimate) each.pose = T_odom_world * each.pose;
  const auto pairs = associate(estimate, truth, Association::kInterpolated, 0);
  const LeverArm fitted = fit_lever_arm(pairs, true);
  EXPECT_EQ(fitted.observed, 3);
  EXPECT_LT((fitted.p_body_point - lever).norm(), 1e-6);
  EXPECT_GT(score(estimate, truth, {}, of_positions()).ate_yaw_m.value(), 0.05);
  const Scores s = score(moved_to_point(estimate, lever), truth, {}, of_positions());
  EXPECT_NEAR(s.ate_yaw_m.value(), 0.0, 1e-9);
}

TEST(LeverArm, OfABodyThatOnlyTurnsAboutTheVerticalHasNoHeight) {
  const Trajectory body = test::sampled(0.0, 60.0, 0.1, eight);
  const Trajectory truth = positions_of(body, {0.12, -0.05, 0.41});
  const LeverArm fitted =
      fit_lever_arm(associate(body, truth, Association::kInterpolated, 0), true);
  EXPECT_EQ(fitted.observed, 2);
  EXPECT_LT((fitted.p_body_point - Eigen::Vector3d(0.12, -0.05, 0.0)).norm(), 1e-6);
  EXPECT_EQ(fit_lever_arm({}, true).observed, 0);
}

TEST(ControlPoints, EarnByTheClassesOfTheHiltiChallenge) {
  const std::vector<double> errors = {0.0, 0.0099, 0.02, 0.05, 0.09, 0.11, 3.0};
  // 10 + 10 + 6 + 3 + 1 of 8 points, one of which was not reached.
  EXPECT_DOUBLE_EQ(control_point_score(errors, 8), 100.0 * 30.0 / 80.0);
  EXPECT_EQ(control_point_score({}, 0), 0.0);
  // Of 2023: 20 + 10 + 6 + 5 + 3 + 1.
  EXPECT_DOUBLE_EQ(control_point_score_2023(errors, 8), 100.0 * 45.0 / 160.0);
}

TEST(ControlPoints, AreComparedAtTheirStampsWithTheEstimateInterpolated) {
  const Trajectory estimate = test::sampled(0.0, 60.0, 1.0, [](double t) {
    return Pose{{1, 0, 0, 0}, {t, 0.1 * t, 0.0}};
  });
  Trajectory truth;
  for (const double t : {0.5, 10.25, 30.75, 59.5, 70.0}) {
    truth.push_back({from_seconds(t), {{1, 0, 0, 0}, {-0.1 * t, t, 7.0}}});
  }
  ScoreConfig config = of_positions();
  config.association = Association::kAtTruth;
  const Scores s = score(estimate, truth, {}, config);
  ASSERT_TRUE(s.control_points);
  EXPECT_EQ(s.control_points->points, 5);
  EXPECT_EQ(s.control_points->reached, 4) << "the last lies after the estimate";
  EXPECT_DOUBLE_EQ(s.control_points->score, 80.0);
  EXPECT_DOUBLE_EQ(s.coverage, 0.8);
  EXPECT_TRUE(s.success);
  EXPECT_NEAR(s.ate_yaw_m.value(), 0.0, 1e-9) << "a turn by 90 degrees and a shift";
  EXPECT_FALSE(score(estimate, truth, {}, ScoreConfig()).control_points);
}

TEST(PartialTruth, IsNotInterpolatedOverItsGapsAndCountsWhereItIs) {
  Trajectory truth = test::sampled(0.0, 20.0, 0.1, eight);
  for (const StampedPose& each : test::sampled(50.0, 60.0, 0.1, eight)) truth.push_back(each);
  // The estimate is right outside the tunnel; inside it has no poses for a while.
  Trajectory estimate = test::sampled(0.0, 30.0, 0.1, eight);
  for (const StampedPose& each : test::sampled(45.0, 60.0, 0.1, eight)) estimate.push_back(each);
  const Scores s = score(estimate, truth, {}, ScoreConfig());
  EXPECT_NEAR(s.ate_m.value(), 0.0, 1e-3) << "a chord through the tunnel would be metres off";
  EXPECT_DOUBLE_EQ(s.coverage, 1.0);
  EXPECT_TRUE(s.success);
  // Half of the second part is missing: 5 of 30 s.
  std::erase_if(estimate, [](const StampedPose& each) { return each.stamp > 55 * kSecond; });
  EXPECT_NEAR(score(estimate, truth, {}, ScoreConfig()).coverage, 25.0 / 30.0, 1e-9);
}

TEST(PartialTruth, GapsAreThoseLongerThanAskedAndKeepTheirEnds) {
  const Trajectory truth = {{0, {}}, {10, {}}, {40, {}}, {45, {}}, {90, {}}};
  const auto gaps = gaps_in(truth, 20);
  ASSERT_EQ(gaps.size(), 2U);
  EXPECT_EQ(time_in(gaps, 0, 90), 30 + 45);
  EXPECT_EQ(time_in(gaps, 20, 50), 20 + 5);
  std::vector<PosePair> pairs(5);
  const Time stamps[] = {10, 11, 40, 44, 46};
  for (int i = 0; i < 5; ++i) pairs[static_cast<std::size_t>(i)].stamp = stamps[i];
  pairs = outside(gaps, pairs);
  ASSERT_EQ(pairs.size(), 3U);
  EXPECT_EQ(pairs[1].stamp, 40);
}

TEST(Scores, StartToEndIsTheEstimatesOwnDistance) {
  const Scores s = score(test::estimated_walk([](double t, Pose pose) {
                           pose.translation.y() += 0.3 * t / test::kEnd;
                           return pose;
                         }),
                         test::true_walk(), {}, ScoreConfig());
  EXPECT_NEAR(s.start_to_end_m.value(), 0.3, 1e-9);
}

}  // namespace
}  // namespace aims
