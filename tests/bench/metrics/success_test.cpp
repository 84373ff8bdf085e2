// SPDX-License-Identifier: BSD-3-Clause
#include "bench/metrics/success.hpp"

#include <gtest/gtest.h>

#include <limits>

#include "bench/metrics/alignment.hpp"
#include "tests/bench/metrics/trajectories.hpp"

namespace aims {
namespace {

SuccessVerdict verdict_of(const Trajectory& estimate, const Trajectory& truth = test::true_walk()) {
  const auto pairs = associate(valid_part(estimate), truth, Association::kInterpolated, 0);
  return judge(estimate, truth, aligned(pairs, align_start(pairs)), SuccessLimits());
}

TEST(Success, OfAPerfectWalk) {
  const SuccessVerdict verdict = verdict_of(test::perfect_walk());
  EXPECT_EQ(verdict.reason, FailureReason::kNone);
  EXPECT_FALSE(verdict.diverged_at);
}

TEST(Success, FailsWhenTheErrorExceedsTheLimit) {
  // A robot thought to stand still: the error x exceeds 5 % of 10 m from x = 0.5 on.
  const auto verdict = verdict_of(test::estimated_walk([](double, Pose pose) {
    pose.translation.x() = 0.0;
    return pose;
  }));
  EXPECT_EQ(verdict.reason, FailureReason::kErrorLimit);
  EXPECT_NEAR(to_seconds(*verdict.diverged_at), 0.55, 0.06);
}

TEST(Success, AllowsErrorsWithinTheLimit) {
  const auto verdict = verdict_of(test::estimated_walk([](double, Pose pose) {
    pose.translation.x() *= 0.96;
    return pose;
  }));
  EXPECT_EQ(verdict.reason, FailureReason::kNone);
}

TEST(Success, IsLostByAScaleErrorThoughTheLoopCloses) {
  // The error 0.06 x exceeds 0.5 m from x = 8.3 on; at the end it is zero again.
  const auto verdict = verdict_of(test::estimated_walk([](double, Pose pose) {
    pose.translation.x() *= 0.94;
    return pose;
  }));
  EXPECT_EQ(verdict.reason, FailureReason::kErrorLimit);
  EXPECT_NEAR(to_seconds(*verdict.diverged_at), 8.4, 0.11);
}

/// The walk but for the first pose, turned by `angle` about the start: the mount is off, or the
/// first attitude.
Trajectory turned_walk(double angle) {
  return test::estimated_walk([angle](double t, Pose pose) {
    return t == 0.0 ? pose : Pose{yaw_rotation(angle), Eigen::Vector3d::Zero()} * pose;
  });
}

TEST(Success, DoesNotDependOnASmallHeadingOfTheWholePath) {
  EXPECT_EQ(verdict_of(turned_walk(0.08)).reason, FailureReason::kNone) << "3.2 m aside at the end";
  EXPECT_EQ(verdict_of(turned_walk(-0.08)).reason, FailureReason::kNone);
}

TEST(Success, IsLostByAPathThatLeadsElsewhere) {
  EXPECT_EQ(verdict_of(turned_walk(0.2)).reason, FailureReason::kErrorLimit);
  EXPECT_EQ(verdict_of(turned_walk(3.14)).reason, FailureReason::kErrorLimit) << "backwards";
}

TEST(Success, FailedWhereItFailedWhateverCameLater) {
  const auto with_jump = [](double size) {
    return verdict_of(test::estimated_walk([size](double t, Pose pose) {
      if (t > 20.0) pose.translation.y() += 3.0;
      if (t > 60.0) pose.translation += size * Eigen::Vector3d(1.0, -2.0, 0.5);
      return pose;
    }));
  };
  EXPECT_EQ(with_jump(0.0).diverged_at, from_seconds(20.1));
  EXPECT_EQ(with_jump(1000.0).diverged_at, from_seconds(20.1));
}

TEST(Success, FailsAtThePoseThatIsNotFinite) {
  Trajectory estimate = test::perfect_walk();
  estimate[100].pose.translation.x() = std::numeric_limits<double>::quiet_NaN();
  const auto verdict = verdict_of(estimate);
  EXPECT_EQ(verdict.reason, FailureReason::kInvalid);
  EXPECT_EQ(verdict.diverged_at, estimate[100].stamp);
}

TEST(Success, FailsWhereTheEstimateEnds) {
  Trajectory estimate = test::perfect_walk();
  estimate.resize(500);
  const auto verdict = verdict_of(estimate);
  EXPECT_EQ(verdict.reason, FailureReason::kEndsEarly);
  EXPECT_EQ(verdict.diverged_at, estimate.back().stamp);
}

TEST(Success, FailsWhereTheEstimateHasAGap) {
  Trajectory estimate = test::perfect_walk();
  estimate.erase(estimate.begin() + 101, estimate.begin() + 200);
  const auto verdict = verdict_of(estimate);
  EXPECT_EQ(verdict.reason, FailureReason::kGap);
  EXPECT_EQ(verdict.diverged_at, from_seconds(10.0));
}

// Errors of such an estimate are those of a part of the run, whatever failed first.
TEST(Success, SaysThatPosesAreMissingAfterAnErrorBeyondTheLimit) {
  Trajectory estimate = test::estimated_walk([](double, Pose pose) {
    pose.translation.x() *= 0.9;
    return pose;
  });
  EXPECT_EQ(verdict_of(estimate).reason, FailureReason::kErrorLimit);
  EXPECT_FALSE(verdict_of(estimate).partial);
  estimate.resize(500);
  EXPECT_EQ(verdict_of(estimate).reason, FailureReason::kErrorLimit);
  EXPECT_TRUE(verdict_of(estimate).partial);
  EXPECT_TRUE(verdict_of({}).partial);
  EXPECT_FALSE(verdict_of(test::perfect_walk()).partial);
}

TEST(Success, AllowsTheTimeToInitializeButNoMore) {
  Trajectory estimate = test::perfect_walk();
  estimate.erase(estimate.begin(), estimate.begin() + 30);
  EXPECT_EQ(verdict_of(estimate).reason, FailureReason::kNone);
  estimate.erase(estimate.begin(), estimate.begin() + 5);
  EXPECT_EQ(verdict_of(estimate).reason, FailureReason::kStartsLate);
}

TEST(Success, NeedsPoses) {
  EXPECT_EQ(verdict_of({}).reason, FailureReason::kNoPoses);
  EXPECT_FALSE(verdict_of({}).diverged_at) << "what never began does not diverge";
  EXPECT_EQ(verdict_of({{0, Pose()}}).reason, FailureReason::kNoOverlap);
  EXPECT_EQ(judge({{0, Pose()}}, {}, {}, SuccessLimits()).reason, FailureReason::kNoOverlap);
}

TEST(Success, EveryReasonHasAName) {
  for (const auto reason :
       {FailureReason::kNoPoses, FailureReason::kNoOverlap, FailureReason::kInvalid,
        FailureReason::kStartsLate, FailureReason::kGap, FailureReason::kEndsEarly,
        FailureReason::kErrorLimit}) {
    EXPECT_FALSE(name_of(reason).empty());
  }
  EXPECT_EQ(name_of(FailureReason::kNone), "");
}

TEST(Success, OfAnEstimateOfLessThanHalfTheTruthIsNone) {
  const Trajectory truth = test::sampled(0.0, 8.0, 0.01, test::there_and_back);
  const Trajectory part = test::sampled(2.5, 5.5, 0.1, test::there_and_back);
  // Within three seconds of either end, so that no other limit is passed.
  EXPECT_EQ(verdict_of(part, truth).reason, FailureReason::kCoverage);
  EXPECT_EQ(verdict_of(test::sampled(1.5, 6.5, 0.1, test::there_and_back), truth).reason,
            FailureReason::kNone);
}

TEST(Coverage, LeavesOutLongGaps) {
  const Trajectory truth = test::sampled(0.0, 10.0, 0.1, test::there_and_back);
  std::vector<PosePair> pairs;
  for (const double t : {0.0, 1.0, 2.0, 7.0, 8.0}) pairs.push_back({from_seconds(t), {}, {}});
  EXPECT_DOUBLE_EQ(coverage_of(pairs, truth, 2 * kSecond), 0.3);
  EXPECT_DOUBLE_EQ(coverage_of(pairs, truth, 5 * kSecond), 0.8);
  EXPECT_EQ(coverage_of({}, truth, kSecond), 0.0);
  EXPECT_EQ(coverage_of(pairs, {}, kSecond), 0.0);
}

}  // namespace
}  // namespace aims
