// SPDX-License-Identifier: BSD-3-Clause
#include "bench/scoring/motion_offset.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

namespace aims {
namespace {

/// Ten times a second from `begin` to `end` [s] of a walk along x at 0.7 m/s that stands still in
/// the first 4 s and from 20 to 25 s; `late` is added to its stamps [s].
Trajectory walk(double begin, double end, double late, bool stands = true) {
  Trajectory poses;
  double x = 0.0;
  for (int i = 0; i <= static_cast<int>(end * 10.0); ++i) {
    const double t = 0.1 * i;
    const bool still = stands && (t < 4.0 || (t > 20.0 && t < 25.0));
    if (!still) x += 0.07;
    if (t < begin) continue;
    poses.push_back({from_seconds(t + late), {Eigen::Quaterniond::Identity(), {x, 0.0, 0.0}}});
  }
  return poses;
}

// The first pose of an estimator comes after its start, so that first poses tell nothing.
TEST(MotionOffset, IsThatOfTheMotionNotOfTheFirstPoses) {
  const auto offset = motion_offset(walk(1.5, 60.0, 1000.0), walk(0.0, 60.0, 0.0));
  ASSERT_TRUE(offset);
  EXPECT_NEAR(offset->seconds, -1000.0, 0.03);
  EXPECT_GT(offset->correlation, 0.95);
  const auto half = motion_offset(walk(0.0, 60.0, -40.0), walk(0.0, 31.0, 0.0));
  ASSERT_TRUE(half) << "a truth of the first half";
  EXPECT_NEAR(half->seconds, 40.0, 0.03);
}

// Speeds of a long recording are compared on a grid of seconds first.
TEST(MotionOffset, OfTwoHoursIsAsExact) {
  Trajectory truth;
  Trajectory estimate;
  double x = 0.0;
  std::uint64_t random = 1;
  bool walks = false;
  for (int i = 0; i < 20 * 6800; ++i) {
    if (i % 100 == 0) {
      random = random * 6364136223846793005ULL + 1442695040888963407ULL;
      walks = (random >> 40U) % 3 != 0;
    }
    if (walks) x += 0.03;
    const Pose pose{Eigen::Quaterniond::Identity(), {x, 0.0, 0.0}};
    truth.push_back({from_seconds(0.05 * i), pose});
    if (i >= 220) estimate.push_back({from_seconds(0.05 * i + 50000.0), pose});
  }
  const auto offset = motion_offset(estimate, truth);
  ASSERT_TRUE(offset);
  EXPECT_NEAR(offset->seconds, -50000.0, 0.01);
}

// Overlapping stamps hide an offset: scores would be those of other instants.
TEST(ClockOffsetHint, IsGivenWhereSpansOverlap) {
  const Trajectory truth = walk(0.0, 60.0, 0.0);
  for (const double late : {3.2, -3.2, 0.5}) {
    Trajectory longer = walk(0.0, 60.0, late);
    for (StampedPose& each : longer) each.pose.translation *= 1.02;
    const std::string hint = clock_offset_hint(longer, truth).value_or("");
    EXPECT_NE(hint.find(fmt::format("--time-offset {:.2f} it stands", -late)), std::string::npos)
        << late << ": " << hint;
  }
  EXPECT_FALSE(clock_offset_hint(walk(1.5, 60.0, 0.0), truth));
  EXPECT_FALSE(clock_offset_hint(walk(0.0, 60.0, 0.1), truth)) << "the delay of an estimator";
}

// One that loses distance for a while moves when the truth does.
TEST(ClockOffsetHint, IsNotGivenOfAWrongEstimate) {
  const Trajectory truth = walk(0.0, 60.0, 0.0);
  Trajectory lost;
  double x = 0.0;
  for (std::size_t i = 0; i < truth.size(); ++i) {
    const double step =
        i == 0 ? 0.0 : truth[i].pose.translation.x() - truth[i - 1].pose.translation.x();
    x += (i > 300 && i < 450 ? 0.3 : 1.0) * step;
    lost.push_back({truth[i].stamp, {Eigen::Quaterniond::Identity(), {x, 0.0, 0.0}}});
  }
  EXPECT_FALSE(clock_offset_hint(lost, truth));
}

// Of two walks one that is lost looks like the other one, half of the time later.
TEST(ClockOffsetHint, IsNotGivenWhereOneOfTwoWalksIsLost) {
  Trajectory truth, lost;
  double x = 0.0, short_x = 0.0;
  for (int i = 0; i < 1340; ++i) {
    const double t = 0.1 * i;
    const bool out = t > 5.0 && t<65.0, back = t> 69.0 && t < 129.0;
    x += out ? 0.07 : back ? -0.07 : 0.0;
    short_x += out ? 0.07 : back ? -0.007 : 0.0;
    truth.push_back({from_seconds(t), {Eigen::Quaterniond::Identity(), {x, 0.0, 0.0}}});
    lost.push_back({from_seconds(t), {Eigen::Quaterniond::Identity(), {short_x, 0.0, 0.0}}});
  }
  EXPECT_EQ(clock_offset_hint(lost, truth).value_or(""), "");
}

TEST(MotionOffset, OfAWalkWithoutAStopIsNotKnown) {
  EXPECT_FALSE(motion_offset(walk(1.5, 60.0, 1000.0, false), walk(0.0, 60.0, 0.0, false)));
  EXPECT_FALSE(motion_offset({}, walk(0.0, 60.0, 0.0)));
  EXPECT_FALSE(motion_offset(walk(0.0, 8.0, 0.0), walk(0.0, 60.0, 0.0))) << "too short";
}

}  // namespace
}  // namespace aims
