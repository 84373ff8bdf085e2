// SPDX-License-Identifier: BSD-3-Clause
#include "bench/metrics/drift.hpp"

#include <gtest/gtest.h>

#include "bench/metrics/alignment.hpp"
#include "tests/bench/metrics/trajectories.hpp"

namespace aims {
namespace {

std::vector<SegmentDrift> drifts_of(const Trajectory& estimate) {
  return segment_drifts(estimate, test::true_walk(), segments_of(test::walk_waypoint_times()),
                        kSecond);
}

DriftSummary summary_of(const Trajectory& estimate) {
  const Trajectory truth = test::true_walk();
  const auto pairs = associate(estimate, truth, Association::kInterpolated, 0);
  return *drift_summary(aligned(pairs, align_start(pairs)), truth,
                        segments_of(test::walk_waypoint_times()));
}

TEST(SegmentDrift, OfAScaleErrorLiesAlongEachSegment) {
  const auto drifts = drifts_of(test::estimated_walk([](double, Pose pose) {
    pose.translation.x() *= 1.01;
    return pose;
  }));
  ASSERT_EQ(drifts.size(), 2U);
  for (const SegmentDrift& each : drifts) {
    EXPECT_NEAR(each.at_end.value().along_m, 0.01 * test::kLength, 1e-9);
    EXPECT_NEAR(each.at_end->lateral_m, 0.0, 1e-9);
    EXPECT_NEAR(each.at_end->vertical_m, 0.0, 1e-9);
    EXPECT_NEAR(each.at_end->heading_rad, 0.0, 1e-9);
  }
}

TEST(SegmentDrift, OfASidewaysSlideIsLateralAndChangesSignOnTheWayBack) {
  const auto drifts = drifts_of(test::estimated_walk([](double t, Pose pose) {
    pose.translation.y() += 0.01 * t;  // to the left of the way there, to the right of the way back
    return pose;
  }));
  EXPECT_NEAR(drifts[0].at_end.value().lateral_m, 0.01 * test::kThere, 1e-9);
  EXPECT_NEAR(drifts[1].at_end.value().lateral_m, -0.01 * (test::kEnd - test::kThere), 1e-9);
}

TEST(SegmentDrift, OfAHeadingRateIsItsIntegral) {
  const double rate = 1e-3;
  const auto drifts = drifts_of(test::estimated_walk([rate](double t, Pose pose) {
    pose.rotation = pose.rotation * yaw_rotation(rate * t);
    return pose;
  }));
  EXPECT_NEAR(drifts[0].at_end.value().heading_rad, rate * test::kThere, 1e-9);
}

TEST(SegmentDrift, HasNoValueWithoutAnEstimate) {
  const auto drifts = drifts_of({});
  ASSERT_EQ(drifts.size(), 2U);
  EXPECT_FALSE(drifts[0].at_end);
}

TEST(DriftSummary, SplitsClimbFromTheRest) {
  const DriftSummary summary = summary_of(test::estimated_walk([](double t, Pose pose) {
    pose.translation.z() -= 0.01 * t;
    return pose;
  }));
  EXPECT_NEAR(summary.end.vertical_m, -0.01 * test::kEnd, 1e-9);
  EXPECT_NEAR(summary.max.vertical_m, 0.01 * test::kEnd, 1e-9);
  EXPECT_NEAR(summary.rmse.vertical_m, 0.01 * test::kEnd / std::sqrt(3.0), 1e-2);
  EXPECT_NEAR(summary.max.along_m, 0.0, 1e-9);
  EXPECT_NEAR(summary.max.lateral_m, 0.0, 1e-9);
}

TEST(DriftSummary, AlongTurnsWithTheSegmentBeingWalked) {
  // The estimate is 1 m short in x from the end of the way there on: behind the true robot at
  // first, ahead of it on the way back.
  const DriftSummary summary = summary_of(test::estimated_walk([](double t, Pose pose) {
    if (t > test::kThere - 1.0) pose.translation.x() -= 1.0;
    return pose;
  }));
  EXPECT_NEAR(summary.end.along_m, 1.0, 1e-9);
}

TEST(DriftSummary, NeedsADirection) {
  const Trajectory truth = test::true_walk();
  const auto pairs = associate(test::perfect_walk(), truth, Association::kInterpolated, 0);
  EXPECT_FALSE(drift_summary(pairs, truth, {}));
  EXPECT_FALSE(drift_summary({}, truth, segments_of(test::walk_waypoint_times())));
}

}  // namespace
}  // namespace aims
