// SPDX-License-Identifier: BSD-3-Clause
#include "bench/metrics/drift.hpp"

#include <gtest/gtest.h>

#include "bench/metrics/alignment.hpp"
#include "tests/bench/metrics/trajectories.hpp"

namespace aims {
namespace {

DriftSummary summary_of(const Trajectory& estimate) {
  const Trajectory truth = test::true_walk();
  const auto pairs = associate(estimate, truth, Association::kInterpolated, 0);
  return *drift_summary(aligned(pairs, align_start(pairs)), truth,
                        segments_of(test::walk_waypoint_times()));
}

TEST(DriftSummary, SeparatesVerticalFromHorizontalErrors) {
  const DriftSummary summary = summary_of(test::estimated_walk([](double t, Pose pose) {
    pose.translation.z() -= 0.01 * t;
    return pose;
  }));
  EXPECT_NEAR(summary.end.vertical_m, -0.01 * test::kEnd, 1e-9);
  EXPECT_NEAR(summary.max.vertical_m, 0.01 * test::kEnd, 1e-9);
  EXPECT_NEAR(summary.rmse.vertical_m, 0.01 * test::kEnd / std::sqrt(3.0), 1e-2);
  EXPECT_NEAR(summary.max.longitudinal_m, 0.0, 1e-9);
  EXPECT_NEAR(summary.max.lateral_m, 0.0, 1e-9);
}

TEST(DriftSummary, LongitudinalAxisFollowsTheSegment) {
  // The estimate is 1 m short in x from the end of the way there on: behind the true robot at
  // first, ahead of it on the way back.
  const DriftSummary summary = summary_of(test::estimated_walk([](double t, Pose pose) {
    if (t > test::kThere - 1.0) pose.translation.x() -= 1.0;
    return pose;
  }));
  EXPECT_NEAR(summary.end.longitudinal_m, 1.0, 1e-9);
}

TEST(DriftSummary, NeedsADirection) {
  const Trajectory truth = test::true_walk();
  const auto pairs = associate(test::perfect_walk(), truth, Association::kInterpolated, 0);
  EXPECT_FALSE(drift_summary(pairs, truth, {}));
  EXPECT_FALSE(drift_summary({}, truth, segments_of(test::walk_waypoint_times())));
}

}  // namespace
}  // namespace aims
