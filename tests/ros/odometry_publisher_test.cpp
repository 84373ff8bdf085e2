// SPDX-License-Identifier: BSD-3-Clause
#include "ros/odometry_publisher.hpp"

#include <gtest/gtest.h>

namespace aims {
namespace {

TEST(OdometryBetween, TwistIsTheMeanMotionInTheAxesOfTheBody) {
  // On a circle of radius 2 m to the left at 0.5 rad/s: 1 m/s forward in the body's axes.
  auto on_circle = [](double seconds) {
    const double angle = 0.5 * seconds;
    StampedPose pose;
    pose.stamp = from_seconds(seconds);
    pose.pose.rotation = so3_exp(Eigen::Vector3d(0.0, 0.0, angle));
    pose.pose.translation = {2.0 * std::sin(angle), 2.0 * (1.0 - std::cos(angle)), 0.0};
    return pose;
  };
  const OdometryContent content = odometry_between(on_circle(3.0), on_circle(3.01));
  EXPECT_NEAR(content.angular_velocity.z(), 0.5, 1e-9);
  // The mean over 10 ms differs by half a turn of 5 mrad from that at the end.
  EXPECT_NEAR(content.linear_velocity.x(), 1.0, 1e-4);
  EXPECT_NEAR(content.linear_velocity.y(), 0.0, 3e-3);
}

TEST(OdometryBetween, TheFirstPoseStandsStill) {
  const StampedPose pose;
  const OdometryContent content = odometry_between(pose, pose);
  EXPECT_EQ(content.linear_velocity, Eigen::Vector3d::Zero());
  EXPECT_EQ(content.angular_velocity, Eigen::Vector3d::Zero());
}

}  // namespace
}  // namespace aims
