// SPDX-License-Identifier: BSD-3-Clause
#include "tests/independent/motion.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "tests/independent/inertial.hpp"

namespace aims::independent {
namespace {

TEST(SmoothMove, CoversItsLengthWithinItsSpeed) {
  const SmoothMove move(10.0, 0.7, 1.2);
  EXPECT_NEAR(move.duration(), 10.0 / 0.7 + 1.2, 1e-12);
  EXPECT_EQ(move.position(-1.0), 0.0);
  EXPECT_NEAR(move.position(move.duration()), 10.0, 1e-12);
  EXPECT_NEAR(move.position(1e3), 10.0, 1e-12);
  for (double t = -0.5; t < move.duration() + 0.5; t += 0.013) {
    const double slope = (move.position(t + 1e-5) - move.position(t - 1e-5)) / 2e-5;
    EXPECT_NEAR(move.rate(t), slope, 1e-7) << t;
    EXPECT_LE(move.rate(t), 0.7 + 1e-12);
  }
}

TEST(Walk, StandsAtItsEndsAndReachesTheFarEnd) {
  const Walk walk({.length = 20.0, .seed = 3});
  EXPECT_EQ(walk.pose(0.0).translation, walk.pose(2.99).translation);
  EXPECT_NEAR(
      (walk.pose(walk.end() + 1e-6).translation - walk.pose(walk.duration()).translation).norm(),
      0.0, 1e-12);
  EXPECT_NEAR(walk.pose(walk.far_end()).translation.x(), 20.0, 1e-9);
  EXPECT_NEAR(walk.pose(walk.end()).translation.x(), 0.0, 1e-9);
  EXPECT_NEAR(std::abs(yaw_of(walk.pose(walk.end()).rotation)), M_PI, 0.1);
}

TEST(Walk, BouncesAndTiltsAsATrot) {
  const Walk walk({.length = 20.0});
  double height = 0.0;
  double tilt = 0.0;
  for (double t = 6.0; t < 20.0; t += 0.01) {
    const Pose pose = walk.pose(t);
    height = std::max(height, std::abs(pose.translation.z() - kBodyHeight));
    tilt = std::max(tilt, std::acos(pose.R()(2, 2)));
  }
  EXPECT_NEAR(height, 0.005, 1e-3);
  EXPECT_GT(tilt, 0.02);
  EXPECT_LT(tilt, 0.04);
}

/// Position, attitude and velocity by integration of ideal IMU samples.
struct DeadReckoning {
  Pose pose;
  Eigen::Vector3d velocity = Eigen::Vector3d::Zero();

  /// Two intervals of length `dt` by Simpson's rule, with the coning term h^2/12 w0 x w2.
  void advance(const ImuSample& s0, const ImuSample& s1, const ImuSample& s2, double dt) {
    const double h = 2.0 * dt;
    const Eigen::Vector3d& w0 = s0.angular_velocity;
    const Eigen::Vector3d& w1 = s1.angular_velocity;
    const Eigen::Vector3d& w2 = s2.angular_velocity;
    const Eigen::Quaterniond middle =
        pose.rotation * so3_exp(h / 24.0 * (5.0 * w0 + 8.0 * w1 - w2));
    const Eigen::Quaterniond end =
        pose.rotation * so3_exp(h / 6.0 * (w0 + 4.0 * w1 + w2) + h * h / 12.0 * w0.cross(w2));
    const Eigen::Vector3d gravity(0.0, 0.0, -kGravity);
    const Eigen::Vector3d a0 = pose.rotation * s0.specific_force + gravity;
    const Eigen::Vector3d a1 = middle * s1.specific_force + gravity;
    const Eigen::Vector3d a2 = end * s2.specific_force + gravity;
    pose.translation += velocity * h + h * h / 6.0 * (a0 + 2.0 * a1);
    velocity += h / 6.0 * (a0 + 4.0 * a1 + a2);
    pose.rotation = end.normalized();
  }
};

TEST(Walk, IntegratedIdealImuReproducesTheWholeRoute) {
  const Walk walk({.seed = 2});
  const std::vector<ImuSample> samples = sample_inertial(walk, ideal_inertial(1000.0));
  DeadReckoning reckoning;
  reckoning.pose = walk.pose(to_seconds(samples.front().stamp));
  double distance = 0.0;
  double angle = 0.0;
  for (std::size_t i = 2; i < samples.size(); i += 2) {
    reckoning.advance(samples[i - 2], samples[i - 1], samples[i], 1e-3);
    const Pose error = walk.pose(to_seconds(samples[i].stamp)).inverse() * reckoning.pose;
    distance = std::max(distance, error.translation.norm());
    angle = std::max(angle, so3_log(error.rotation).norm());
  }
  EXPECT_GT(samples.size(), 200000u);
  EXPECT_LT(distance, 0.01);
  EXPECT_LT(angle, 1e-7);
}

}  // namespace
}  // namespace aims::independent
