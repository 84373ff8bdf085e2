// SPDX-License-Identifier: BSD-3-Clause
#include "bench/metrics/scores.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "tests/bench/metrics/trajectories.hpp"

namespace aims {
namespace {

Scores scores_of(const Trajectory& estimate) {
  return score(estimate, test::true_walk(), test::walk_waypoint_times(), ScoreConfig());
}

/// Every number of the scores that has a value.
std::vector<double> numbers_of(const Scores& s) {
  std::vector<double> numbers;
  const auto take = [&numbers](const std::optional<double>& value) {
    if (value) numbers.push_back(*value);
  };
  for (const SegmentDistance& each : s.segments) {
    numbers.push_back(each.true_distance_m);
    take(each.estimated_distance_m);
    take(each.percent);
    take(each.signed_percent);
  }
  if (s.m_end) numbers.insert(numbers.end(), {s.m_end->norm_m, s.m_end->xy_m, s.m_end->z_m});
  for (const auto& each :
       {s.m_list_percent, s.ate_m, s.ate_se3_m, s.ate_yaw_m, s.max_error_m, s.max_abs_z_error_m,
        s.heading_error_rad, s.heading_offset_rad, s.path_errors.all.translation_percent,
        s.path_errors.all.rotation_deg_per_m}) {
    take(each);
  }
  for (const RpeScore& each : s.rpe) {
    take(each.translation_rmse_m);
    take(each.rotation_rmse_rad);
  }
  const auto take_axes = [&numbers](const AxisError& e) {
    numbers.insert(numbers.end(),
                   {e.longitudinal_m, e.lateral_m, e.vertical_m, e.heading_rad, e.tilt_rad});
  };
  if (s.drift) {
    take_axes(s.drift->rmse);
    take_axes(s.drift->max);
    take_axes(s.drift->end);
  }
  return numbers;
}

TEST(Scores, OfAPerfectEstimateAreZeroInAnyFrame) {
  const Scores s = scores_of(test::perfect_walk());
  EXPECT_TRUE(s.success);
  EXPECT_EQ(s.failure_reason, FailureReason::kNone);
  EXPECT_EQ(s.poses_compared, s.poses);
  EXPECT_NEAR(s.m_list_percent.value(), 0.0, 1e-9);
  EXPECT_NEAR(s.m_end.value().norm_m, 0.0, 1e-9);
  EXPECT_NEAR(s.ate_m.value(), 0.0, 1e-9);
  EXPECT_NEAR(s.ate_yaw_m.value(), 0.0, 1e-9);
  EXPECT_NEAR(s.ate_se3_m.value(), 0.0, 1e-9);
  EXPECT_EQ(s.se3_spread, PositionSpread::kLine) << "a straight corridor does not tell the roll";
  ASSERT_EQ(s.rpe.size(), 2U);
  EXPECT_NEAR(s.rpe[1].translation_rmse_m.value(), 0.0, 1e-9);
}

TEST(Scores, OfAScaleErrorAppearInEachSegmentThoughTheLoopCloses) {
  const Scores s = scores_of(test::estimated_walk([](double, Pose pose) {
    pose.translation.x() *= 0.99;
    return pose;
  }));
  EXPECT_NEAR(s.m_end.value().norm_m, 0.0, 1e-9);
  EXPECT_NEAR(s.segments.at(0).signed_percent.value(), -1.0, 1e-9);
  EXPECT_NEAR(s.segments.at(1).signed_percent.value(), -1.0, 1e-9);
  EXPECT_NEAR(s.max_error_m.value(), 0.01 * test::kLength, 1e-9);
}

TEST(Scores, EndErrorIsSplitIntoHorizontalAndVertical) {
  const Scores s = scores_of(test::estimated_walk([](double t, Pose pose) {
    pose.translation += t / test::kEnd * Eigen::Vector3d(0.3, 0.4, -1.2);
    return pose;
  }));
  EXPECT_NEAR(s.m_end.value().norm_m, 1.3, 1e-9);
  EXPECT_NEAR(s.m_end->xy_m, 0.5, 1e-9);
  EXPECT_NEAR(s.m_end->z_m, 1.2, 1e-9);
  EXPECT_NEAR(s.max_abs_z_error_m.value(), 1.2, 1e-9);
  EXPECT_GT(*s.ate_m, *s.ate_yaw_m);
}

TEST(Scores, AnInitialHeadingErrorSwingsTheFarEndAside) {
  // The first pose is right, all later ones are turned by psi about the start.
  const double psi = 0.01;
  const Scores s = scores_of(test::estimated_walk([psi](double t, Pose pose) {
    return t == 0.0 ? pose : Pose{yaw_rotation(psi), Eigen::Vector3d::Zero()} * pose;
  }));
  EXPECT_NEAR(s.max_error_m.value(), 2.0 * test::kLength * std::sin(0.5 * psi), 1e-9);
  EXPECT_NEAR(s.ate_yaw_m.value(), 0.0, 1e-9);
  EXPECT_NEAR(s.heading_offset_rad.value(), -psi, 1e-6);
  EXPECT_LT(s.heading_error_rad.value(), psi / 20.0) << "of the first pose alone";
  EXPECT_TRUE(s.success_1_percent) << "the heading is a gauge freedom";
  EXPECT_NEAR(s.m_list_percent.value(), 0.0, 1e-6);
  EXPECT_NEAR(s.drift.value().max.lateral_m, test::kLength * std::sin(psi), 1e-9);
  EXPECT_NEAR(s.drift->end.heading_rad, psi, 1e-9);
}

TEST(Scores, HeadingErrorIsThatOfTheAttitudeWhereThePathIsRight) {
  const double psi = 0.007;
  const Scores s = scores_of(test::estimated_walk([psi](double, Pose pose) {
    pose.rotation = pose.rotation * yaw_rotation(psi);
    return pose;
  }));
  EXPECT_NEAR(s.ate_yaw_m.value(), 0.0, 1e-9);
  EXPECT_NEAR(s.heading_error_rad.value(), psi, 1e-9);
  EXPECT_NEAR(s.heading_offset_rad.value(), psi, 1e-9) << "the first pose turned the path";
  EXPECT_GT(s.ate_m.value(), 0.1);
}

TEST(Scores, TellOneAndFivePercentOfTheDistanceApart) {
  const auto with_scale = [](double scale) {
    return scores_of(test::estimated_walk([scale](double, Pose pose) {
      pose.translation.x() *= scale;
      return pose;
    }));
  };
  EXPECT_TRUE(with_scale(0.991).success_1_percent);
  EXPECT_FALSE(with_scale(0.989).success_1_percent);
  EXPECT_TRUE(with_scale(1.049).success);
  EXPECT_FALSE(with_scale(1.051).success);
  EXPECT_FALSE(with_scale(1.051).success_1_percent);
}

TEST(Scores, TakeLessThanTenMetresAsTenMetres) {
  const auto with_step = [](double size) {
    return scores_of(test::estimated_walk([size](double t, Pose pose) {
      if (t > 2.0 && t < 4.0) pose.translation.x() += size;
      return pose;
    }));
  };
  EXPECT_TRUE(with_step(0.09).success_1_percent);
  EXPECT_FALSE(with_step(0.12).success_1_percent);
  EXPECT_TRUE(with_step(0.45).success);
  EXPECT_FALSE(with_step(0.7).success);
}

TEST(Scores, StatisticsOfTheAbsoluteErrorAreThoseOfItsDefinitions) {
  // After alignment the errors of 0.99 x are 0.01 |x - mean x| along one line.
  const Scores s = scores_of(test::estimated_walk([](double, Pose pose) {
    pose.translation.x() *= 0.99;
    return pose;
  }));
  std::vector<double> errors;
  double mean_x = 0.0;
  const Trajectory walk = test::sampled(0.0, test::kEnd, 0.1, test::there_and_back);
  for (const StampedPose& each : walk) mean_x += each.pose.translation.x() / double(walk.size());
  for (const StampedPose& each : walk) {
    errors.push_back(0.01 * std::abs(each.pose.translation.x() - mean_x));
  }
  std::ranges::sort(errors);
  double sum = 0.0;
  double squares = 0.0;
  for (const double each : errors) {
    sum += each;
    squares += each * each;
  }
  const double count = static_cast<double>(errors.size());
  EXPECT_NEAR(s.ape_yaw.value().mean_m, sum / count, 1e-9);
  EXPECT_NEAR(s.ape_yaw->median_m, errors[errors.size() / 2], 1e-9) << "of an odd number";
  EXPECT_NEAR(s.ape_yaw->std_m, std::sqrt(squares / count - std::pow(sum / count, 2)), 1e-9);
  EXPECT_NEAR(s.ape_yaw->min_m, errors.front(), 1e-9);
  EXPECT_NEAR(s.ape_yaw->max_m, errors.back(), 1e-9);
  EXPECT_NEAR(*s.ate_yaw_m, std::sqrt(squares / count), 1e-9);
}

TEST(Scores, WithAScaleOnRequestAreFreeOfAScaleError) {
  ScoreConfig config;
  const Trajectory estimate = test::estimated_walk([](double, Pose pose) {
    pose.translation *= 0.8;
    return pose;
  });
  const auto scored = [&] {
    return score(estimate, test::true_walk(), test::walk_waypoint_times(), config);
  };
  EXPECT_FALSE(scored().ate_sim3_m);
  config.sim3 = true;
  EXPECT_NEAR(scored().sim3_scale.value(), 1.25, 1e-9);
  EXPECT_NEAR(scored().ate_sim3_m.value(), 0.0, 1e-9);
}

// The estimate takes the body for tilted; its path is right.
TEST(Scores, AnAttitudeThatIsTiltedInBodyAxesIsSeenThoughThePathIsRight) {
  const Eigen::Vector3d tilt(0.03, -0.04, 0.0);
  const Scores s = scores_of(test::estimated_walk([&tilt](double, Pose pose) {
    pose.rotation = pose.rotation * so3_exp(tilt);
    return pose;
  }));
  EXPECT_NEAR(s.drift.value().rmse.tilt_rad, tilt.norm(), 1e-6);
  EXPECT_NEAR(s.drift->max.tilt_rad, tilt.norm(), 1e-6);
  EXPECT_NEAR(s.drift->end.tilt_rad, tilt.norm(), 1e-6);
  EXPECT_LT(s.max_error_m.value(), 0.2) << "but for the heading that the first pose gives";
}

TEST(Scores, OfATiltedEstimateOfAStraightWalkHaveNoErrorAfterSe3Alignment) {
  const Pose tilt = {so3_exp({0.005, 0.01, 0.0}), Eigen::Vector3d::Zero()};
  const Scores s =
      scores_of(test::estimated_walk([&tilt](double, const Pose& pose) { return tilt * pose; }));
  EXPECT_GT(*s.ate_yaw_m, 0.05);
  EXPECT_NEAR(s.ate_se3_m.value(), 0.0, 1e-9);
}

TEST(Scores, OfPoorDataAreMarkedAndFinite) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  Trajectory all_nan = test::perfect_walk();
  for (StampedPose& each : all_nan) each.pose.translation.y() = nan;
  Trajectory some_nan = test::perfect_walk();
  for (std::size_t i = 0; i < some_nan.size(); i += 3) some_nan[i].pose.rotation.x() = nan;
  Trajectory elsewhen = test::perfect_walk();
  for (StampedPose& each : elsewhen) each.stamp += from_seconds(1e6);
  Trajectory backwards = test::perfect_walk();
  std::reverse(backwards.begin(), backwards.end());
  Trajectory far = test::perfect_walk();
  for (StampedPose& each : far) each.pose.translation *= 1e300;
  Trajectory half = test::perfect_walk();
  half.resize(half.size() / 2);
  const Trajectory one = {test::perfect_walk().front()};
  for (const Trajectory& poor :
       {Trajectory(), all_nan, some_nan, elsewhen, backwards, far, half, one}) {
    const Scores s = scores_of(poor);
    EXPECT_FALSE(s.success);
    EXPECT_NE(s.failure_reason, FailureReason::kNone);
    EXPECT_EQ(s.diverged_at.has_value(), !poor.empty());
    for (const double number : numbers_of(s)) EXPECT_TRUE(std::isfinite(number));
  }
}

TEST(Scores, WithoutTruthOrWaypointTimeAreMarked) {
  const ScoreConfig config;
  EXPECT_FALSE(score(test::perfect_walk(), {}, test::walk_waypoint_times(), config).success);
  const Scores s = score(test::perfect_walk(), test::true_walk(), {}, config);
  EXPECT_TRUE(s.success);
  EXPECT_FALSE(s.m_list_percent);
  EXPECT_FALSE(s.drift);
  EXPECT_TRUE(s.ate_m);
}

TEST(Scores, AnEstimateThatStopsHasNoEndError) {
  Trajectory estimate = test::perfect_walk();
  estimate.resize(estimate.size() / 2);
  EXPECT_FALSE(scores_of(estimate).m_end);
}

TEST(Scores, OfOnePoseAreUndefined) {
  const Trajectory truth = test::sampled(0.0, 1.0, 0.1, test::there_and_back);
  const Scores s = score({truth[3]}, truth, {}, ScoreConfig());
  EXPECT_FALSE(s.success);
  EXPECT_FALSE(s.ate_m);
  EXPECT_FALSE(s.m_end);
}

TEST(ScoreConfig, DefaultsLieInTheirRanges) {
  ScoreConfig config;
  for (const Parameter& each : fields_of(config).parameters()) {
    EXPECT_TRUE(each.assign(each.text())) << each.key;
    EXPECT_FALSE(each.spec.meaning.empty()) << each.key;
  }
}

TEST(Scores, OverGivenSegmentsIgnoreNamesAndWaypointTimes) {
  ScoreConfig config;
  config.segments = {"x-y"};
  const std::vector<Segment> half = {{"half", 0, from_seconds(20.0)}};
  const Scores scores = score_over(test::estimated_walk([](double, Pose pose) {
                                     pose.translation *= 0.9;
                                     return pose;
                                   }),
                                   test::true_walk(), half, config);
  ASSERT_EQ(scores.segments.size(), 1U);
  EXPECT_EQ(scores.segments[0].segment.name, "half");
  EXPECT_NEAR(scores.segments[0].true_distance_m, 20.0, 1e-9);
  EXPECT_NEAR(*scores.m_list_percent, 10.0, 1e-9);
}

}  // namespace
}  // namespace aims
