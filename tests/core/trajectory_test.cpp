// SPDX-License-Identifier: BSD-3-Clause
#include "core/trajectory.hpp"

#include <gtest/gtest.h>

namespace aims {
namespace {

const Trajectory kTwo = {{10, {yaw_rotation(0.0), {0.0, 0.0, 0.0}}},
                         {20, {yaw_rotation(1.0), {2.0, -4.0, 6.0}}}};

TEST(PoseAt, MeetsTheSamplesExactly) {
  EXPECT_EQ(pose_at(kTwo, 10)->translation, kTwo[0].pose.translation);
  EXPECT_EQ(pose_at(kTwo, 20)->translation, kTwo[1].pose.translation);
}

TEST(PoseAt, InterpolatesBetweenSamples) {
  const Pose pose = pose_at(kTwo, 15).value();
  EXPECT_LT((pose.translation - Eigen::Vector3d(1.0, -2.0, 3.0)).norm(), 1e-14);
  EXPECT_NEAR(yaw_of(pose.rotation), 0.5, 1e-14);
}

TEST(PoseAt, IsEmptyOutsideTheSpan) {
  EXPECT_FALSE(pose_at(kTwo, 9));
  EXPECT_FALSE(pose_at(kTwo, 21));
  EXPECT_FALSE(pose_at({}, 0));
}

TEST(PoseAt, OfASingleSampleIsThatSample) {
  EXPECT_TRUE(pose_at({kTwo[0]}, 10));
  EXPECT_FALSE(pose_at({kTwo[0]}, 11));
}

TEST(PoseAt, KeepsNanosecondsOfLargeStamps) {
  // Epoch stamps: as doubles in seconds they would resolve 240 ns only.
  const Time epoch = 1'700'000'000 * kSecond;
  const Trajectory late = {{epoch, {Eigen::Quaterniond::Identity(), {0.0, 0.0, 0.0}}},
                           {epoch + 4, {Eigen::Quaterniond::Identity(), {4.0, 0.0, 0.0}}}};
  EXPECT_NEAR(pose_at(late, epoch + 1)->translation.x(), 1.0, 1e-14);
}

TEST(Thinned, KeepsTheFirstPoseAndThenThoseSpacingApart) {
  Trajectory dense;
  for (Time stamp = 5; stamp <= 35; stamp += 3) dense.push_back({stamp, {}});
  std::vector<Time> stamps;
  for (const StampedPose& each : thinned(dense, 10)) stamps.push_back(each.stamp);
  EXPECT_EQ(stamps, (std::vector<Time>{5, 17, 29}));
  EXPECT_TRUE(thinned({}, 10).empty());
}

}  // namespace
}  // namespace aims
