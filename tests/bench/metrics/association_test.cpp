// SPDX-License-Identifier: BSD-3-Clause
#include "bench/metrics/association.hpp"

#include <gtest/gtest.h>

#include <limits>

#include "tests/bench/metrics/trajectories.hpp"

namespace aims {
namespace {

Pose at_x(double x) { return {Eigen::Quaterniond::Identity(), {x, 0.0, 0.0}}; }

TEST(Association, InterpolatesTheTruthAtTheEstimatesStamps) {
  const Trajectory truth = {{0, at_x(0.0)}, {10, at_x(1.0)}};
  const Trajectory estimate = {{-1, at_x(7.0)}, {0, at_x(7.0)}, {4, at_x(7.0)}, {11, at_x(7.0)}};
  const auto pairs = associate(estimate, truth, Association::kInterpolated, 0);
  ASSERT_EQ(pairs.size(), 2U);
  EXPECT_EQ(pairs[1].stamp, 4);
  EXPECT_NEAR(pairs[1].truth.translation.x(), 0.4, 1e-15);
  EXPECT_EQ(pairs[1].estimate.translation.x(), 7.0);
}

TEST(Association, NearestKeepsToTheTolerance) {
  const Trajectory truth = {{0, at_x(0.0)}, {10, at_x(1.0)}, {20, at_x(2.0)}};
  const Trajectory estimate = {{3, at_x(5.0)}, {14, at_x(6.0)}};
  const auto pairs = associate(estimate, truth, Association::kNearest, 3);
  ASSERT_EQ(pairs.size(), 1U);
  EXPECT_EQ(pairs[0].truth.translation.x(), 0.0);
}

TEST(Association, NearestGivesATieToTheEarlier) {
  const Trajectory truth = {{0, at_x(0.0)}, {10, at_x(1.0)}};
  const auto pairs = associate({{5, at_x(5.0)}}, truth, Association::kNearest, 5);
  ASSERT_EQ(pairs.size(), 1U);
  EXPECT_EQ(pairs[0].truth.translation.x(), 0.0);
}

TEST(Association, TheShorterTrajectoryChooses) {
  const Trajectory truth = {{10, at_x(1.0)}};
  const Trajectory estimate = {{0, at_x(5.0)}, {9, at_x(6.0)}, {12, at_x(7.0)}};
  const auto pairs = associate(estimate, truth, Association::kNearest, 5);
  ASSERT_EQ(pairs.size(), 1U);
  EXPECT_EQ(pairs[0].stamp, 9);
  EXPECT_EQ(pairs[0].estimate.translation.x(), 6.0);
}

TEST(Association, OfNothingIsEmpty) {
  const Trajectory some = {{0, at_x(0.0)}};
  for (const auto kind : {Association::kNearest, Association::kInterpolated}) {
    EXPECT_TRUE(associate({}, some, kind, 5).empty());
    EXPECT_TRUE(associate(some, {}, kind, 5).empty());
  }
}

TEST(ValidPart, LeavesOutWhatIsNoPoseOrOutOfOrder) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  Pose unnormalized = at_x(1.0);
  unnormalized.rotation.coeffs() *= 2.0;
  Pose bad_rotation = at_x(1.0);
  bad_rotation.rotation.w() = nan;
  const Trajectory mixed = {{0, at_x(0.0)},    {1, at_x(nan)}, {2, unnormalized},
                            {3, bad_rotation}, {4, at_x(1e9)}, {5, at_x(2.0)},
                            {5, at_x(3.0)},    {2, at_x(4.0)}, {6, at_x(5.0)}};
  const Trajectory valid = valid_part(mixed);
  ASSERT_EQ(valid.size(), 3U);
  EXPECT_EQ(valid[1].pose.translation.x(), 2.0);
  EXPECT_EQ(valid[2].stamp, 6);
}

TEST(Association, MedianStampDifferenceIsToTheNearestTruePoseInsideItsSpan) {
  Trajectory truth;
  for (const Time stamp : {0, 100, 200, 300}) truth.push_back({stamp, Pose()});
  // 10, 40 and 20 away; those outside do not count.
  const Trajectory estimate = {
      {-50, Pose()}, {10, Pose()}, {140, Pose()}, {280, Pose()}, {900, Pose()}};
  EXPECT_EQ(median_stamp_difference(estimate, truth), 20);
  EXPECT_FALSE(median_stamp_difference({{900, Pose()}}, truth));
  EXPECT_FALSE(median_stamp_difference(estimate, {}));
}

}  // namespace
}  // namespace aims
