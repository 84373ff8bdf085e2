// SPDX-License-Identifier: BSD-3-Clause
#include "live/publications.hpp"

#include <gtest/gtest.h>

#include <iostream>
#include <random>
#include <vector>

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

/// The covariance of `rows`, whose mean is zero.
Eigen::Matrix<double, 6, 6> covariance_of(const std::vector<Eigen::Matrix<double, 6, 1>>& rows) {
  Eigen::Matrix<double, 6, 6> sum = Eigen::Matrix<double, 6, 6>::Zero();
  for (const auto& row : rows) sum += row * row.transpose();
  return sum / static_cast<double>(rows.size());
}

// Draws errors of the estimate, and holds the message's covariances against what they make of the
// quantities that the message defines.
TEST(OdometryOf, CovariancesAreThoseOfTheQuantitiesOfTheMessage) {
  constexpr unsigned kSeed = 11;
  std::cout << "seed " << kSeed << "\n";
  std::mt19937 random(kSeed);
  std::normal_distribution<double> normal;
  MotionEstimate motion;
  motion.T_odom_body = {so3_exp(Eigen::Vector3d(0.3, -0.5, 1.9)), Eigen::Vector3d(4.0, -2.0, 0.3)};
  motion.velocity = {0.9, -0.4, 0.1};
  motion.angular_velocity = {0.1, -0.2, 0.6};
  Eigen::Matrix<double, 9, 9> root = Eigen::Matrix<double, 9, 9>::Zero();
  for (int i = 0; i < 81; ++i) root(i / 9, i % 9) = 0.004 * normal(random);
  motion.covariance = root * root.transpose();
  motion.rate_covariance = Eigen::Vector3d(1e-6, 4e-6, 9e-6).asDiagonal();
  const OdometryContent content = odometry_of(motion);

  std::vector<Eigen::Matrix<double, 6, 1>> poses;
  std::vector<Eigen::Matrix<double, 6, 1>> velocities;
  for (int draw = 0; draw < 100'000; ++draw) {
    Eigen::Matrix<double, 9, 1> noise;
    for (double& each : noise) each = normal(random);
    const Eigen::Matrix<double, 9, 1> error = root * noise;
    const Eigen::Quaterniond true_rotation = motion.T_odom_body.rotation * so3_exp(error.head<3>());
    Eigen::Matrix<double, 6, 1> pose;
    pose << error.segment<3>(3),
        so3_log(true_rotation * motion.T_odom_body.rotation.conjugate());  // about fixed axes
    poses.push_back(pose);
    Eigen::Matrix<double, 6, 1> velocity = Eigen::Matrix<double, 6, 1>::Zero();
    velocity.head<3>() =
        true_rotation.conjugate() * (motion.velocity + error.tail<3>()) - content.linear_velocity;
    velocities.push_back(velocity);
  }
  const double scale = content.pose_covariance.cwiseAbs().maxCoeff();
  EXPECT_LT((covariance_of(poses) - content.pose_covariance).cwiseAbs().maxCoeff(), 0.03 * scale);
  const auto linear = content.twist_covariance.topLeftCorner<3, 3>();
  const double most = linear.cwiseAbs().maxCoeff();
  EXPECT_LT((covariance_of(velocities).topLeftCorner<3, 3>() - linear).cwiseAbs().maxCoeff(),
            0.03 * most);
  EXPECT_EQ((content.twist_covariance.bottomRightCorner<3, 3>()), motion.rate_covariance);
  EXPECT_TRUE(content.angular_velocity.isApprox(motion.angular_velocity));
}

TEST(PlacedAt, TurnsWhatIsInTheFrameAndLeavesWhatIsInTheBody) {
  MotionEstimate motion;
  motion.T_odom_body = {so3_exp(Eigen::Vector3d(0.3, -0.5, 1.9)), Eigen::Vector3d(4.0, -2.0, 0.3)};
  motion.velocity = {0.9, -0.4, 0.1};
  Eigen::Matrix<double, 9, 9> root;
  for (int i = 0; i < 81; ++i) root(i / 9, i % 9) = 0.01 * ((i * 37) % 19 - 9);
  motion.covariance = root * root.transpose();
  Pose tilted = motion.T_odom_body;
  tilted.translation = {10.0, 20.0, 1.0};
  const Pose T = level(tilted);
  EXPECT_NEAR((T.R() * Eigen::Vector3d::UnitZ() - Eigen::Vector3d::UnitZ()).norm(), 0.0, 1e-12);
  EXPECT_NEAR((T.R().transpose() * tilted.R().col(0)).y(), 0.0, 1e-12) << "the same heading";

  const OdometryContent before = odometry_of(motion);
  const OdometryContent after = odometry_of(placed_at(T, motion));
  Eigen::Matrix<double, 6, 6> turn = Eigen::Matrix<double, 6, 6>::Zero();
  turn.topLeftCorner<3, 3>() = turn.bottomRightCorner<3, 3>() = T.R();
  EXPECT_LT((after.pose.translation - T * before.pose.translation).norm(), 1e-12);
  EXPECT_LT((after.pose_covariance - turn * before.pose_covariance * turn.transpose()).norm(),
            1e-12);
  EXPECT_LT((after.linear_velocity - before.linear_velocity).norm(), 1e-12);
  EXPECT_LT((after.twist_covariance - before.twist_covariance).norm(), 1e-12);
}

}  // namespace
}  // namespace aims
