// SPDX-License-Identifier: BSD-3-Clause
#include "sim/sensors/pose_cursor.hpp"

#include <gtest/gtest.h>

namespace aims {
namespace {

/// Turns of several sizes, one of them none, and one with the quaternion of the other sign.
Trajectory turning_poses() {
  Trajectory poses;
  Pose pose;
  const double turns[] = {0.01, 0.0, 1.5, -3.0, 0.2, 1e-9};
  for (int i = 0; i < 6; ++i) {
    pose.rotation = pose.rotation * so3_exp(turns[i] * Eigen::Vector3d(0.6, 0.0, 0.8));
    if (i == 3) pose.rotation.coeffs() *= -1.0;
    pose.translation += Eigen::Vector3d(0.1, -0.2 * i, 0.3);
    poses.push_back({100 + 50 * i, pose});
  }
  return poses;
}

TEST(PoseCursor, IsInterpolationBitForBit) {
  const Trajectory poses = turning_poses();
  PoseCursor cursor(poses);
  for (Time stamp = 80; stamp < 370; stamp += 3) {
    const Pose found = cursor.at(stamp);
    const Time inside = std::clamp(stamp, poses.front().stamp, poses.back().stamp);
    std::size_t next = 1;
    while (poses[next].stamp < inside) ++next;
    const double fraction = to_seconds(inside - poses[next - 1].stamp) / to_seconds(50);
    const Pose expected = inside == poses[0].stamp ? poses.front().pose
                          : inside == poses.back().stamp
                              ? poses.back().pose
                              : interpolate(poses[next - 1].pose, poses[next].pose, fraction);
    EXPECT_EQ(found.rotation.coeffs(), expected.rotation.coeffs()) << stamp;
    EXPECT_EQ(found.translation, expected.translation) << stamp;
  }
}

}  // namespace
}  // namespace aims
