// SPDX-License-Identifier: BSD-3-Clause
#include "estimator/baselines/lio_sam/imu_odometry.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace aims::lio_sam {
namespace {

using Eigen::Vector3d;

constexpr Duration kPeriod = 5 * kMillisecond;
constexpr Duration kScanInterval = 200 * kMillisecond;

/// A LiDAR that swings and turns; closed form.
struct Motion {
  Vector3d lever = Vector3d::Zero();  ///< of the IMU in LiDAR axes [m]
  ImuBias bias;
  double gravity = ImuOdometryConfig().gravity;

  static Eigen::Quaterniond rotation(double t) { return yaw_rotation(0.3 * std::sin(t)); }
  static Vector3d rate(double t) { return {0.0, 0.0, 0.3 * std::cos(t)}; }
  static Vector3d position(double t) { return {0.7 * t, 0.2 * std::sin(t), 0.1 * std::cos(t)}; }
  Vector3d imu_position(double t) const { return position(t) + rotation(t) * lever; }
  static Pose pose(double t) { return {rotation(t), position(t)}; }

  /// The mean over the interval that ends at the stamp, nearly.
  ImuSample sample(Time stamp) const {
    constexpr double h = 1e-4;
    const double t = to_seconds(stamp - kPeriod / 2);
    const Vector3d acceleration =
        (imu_position(t + h) - 2.0 * imu_position(t) + imu_position(t - h)) / (h * h);
    const Vector3d force =
        rotation(t).conjugate() * Vector3d(acceleration + Vector3d(0.0, 0.0, gravity));
    return {stamp, rate(t) + bias.gyro, force + bias.accelerometer};
  }
};

/// Feeds samples and, every 200 ms, the true pose of the LiDAR 10 ms late; hands every pose out.
template <class Use>
void follow(ImuOdometry& odometry, const Motion& motion, Time from, Time until, Use use) {
  for (Time stamp = from + kPeriod; stamp <= until; stamp += kPeriod) {
    if (const auto pose = odometry.add(motion.sample(stamp))) use(*pose);
    if (stamp % kScanInterval != 2 * kPeriod) continue;
    const Time scan = stamp - 2 * kPeriod;
    odometry.correct({scan, Motion::pose(to_seconds(scan)), false});
  }
}

TEST(LioSamImuOdometry, FollowsTheMotionBetweenScans) {
  Motion motion;
  motion.lever = {0.2, -0.1, 0.3};
  ImuOdometry odometry(ImuOdometryConfig(), motion.lever);
  double worst = 0.0;
  int poses = 0;
  follow(odometry, motion, 0, 10 * kSecond, [&](const StampedPose& each) {
    const Vector3d truth = Motion::position(to_seconds(each.stamp));
    if (each.stamp > 2 * kSecond) {
      worst = std::max(worst, (each.pose.translation - truth).norm());
    }
    ++poses;
  });
  // Each sample counts as from one sample before a scan on: 5 ms at 0.7 m/s.
  EXPECT_LT(worst, 0.02);
  EXPECT_GT(poses, 1800);
  EXPECT_TRUE(odometry.failures().empty());
  const Time last = 10 * kSecond - kScanInterval;
  const Vector3d velocity = (motion.imu_position(to_seconds(last) + 1e-5) -
                             motion.imu_position(to_seconds(last) - 1e-5)) /
                            2e-5;
  EXPECT_LT((odometry.state().velocity - velocity).norm(), 0.05);
}

TEST(LioSamImuOdometry, FindsTheGyroBias) {
  Motion motion;
  motion.bias.gyro = {0.0, 0.0, 0.004};
  ImuOdometryConfig config;
  config.prior_bias_sigma = 0.1;
  config.rotation_sigma = 0.001;
  ImuOdometry odometry(config, motion.lever);
  follow(odometry, motion, 0, 15 * kSecond, [](const StampedPose&) {});
  EXPECT_NEAR(odometry.bias().gyro.z(), 0.004, 0.0004);
}

/// A graph that starts anew keeps what it knew: a wrong pose soon after moves the bias as little.
TEST(LioSamImuOdometry, ANewGraphCarriesTheCovariancesOver) {
  Motion motion;
  motion.bias.gyro = {0.0, 0.0, 0.004};
  const auto moved_with = [&](int max_keys) {
    ImuOdometryConfig config;
    config.prior_bias_sigma = 0.1;
    config.rotation_sigma = 0.001;
    config.max_keys = max_keys;
    ImuOdometry odometry(config, motion.lever);
    follow(odometry, motion, 0, 16 * kSecond, [](const StampedPose&) {});
    const double before = odometry.bias().gyro.z();
    EXPECT_NEAR(before, 0.004, 2e-4);
    const Time last = 16 * kSecond + kScanInterval;
    for (Time t = 16 * kSecond + kPeriod; t <= last; t += kPeriod) {
      (void)odometry.add(motion.sample(t));
    }
    Pose wrong = Motion::pose(to_seconds(last));
    wrong.rotation = wrong.rotation * yaw_rotation(0.01);
    odometry.correct({last, wrong, false});
    return std::abs(odometry.bias().gyro.z() - before);
  };
  EXPECT_GT(moved_with(1000), 1e-6);
  EXPECT_LT(moved_with(20), 1.5 * moved_with(1000));
}

TEST(LioSamImuOdometry, ADegenerateScanMovesTheStateLess) {
  const Motion motion;
  const auto error_with = [&](bool degenerate) {
    ImuOdometry odometry(ImuOdometryConfig(), motion.lever);
    follow(odometry, motion, 0, 5 * kSecond, [](const StampedPose&) {});
    for (Time stamp = 5 * kSecond + kPeriod; stamp <= 5 * kSecond + 50 * kMillisecond;
         stamp += kPeriod) {
      (void)odometry.add(motion.sample(stamp));
    }
    Pose wrong = Motion::pose(5.0);
    wrong.translation.x() += 0.5;
    odometry.correct({5 * kSecond, wrong, degenerate});
    return (odometry.state().T_map_imu.translation - Motion::position(5.0)).norm();
  };
  EXPECT_LT(error_with(true), 0.3 * error_with(false));
}

TEST(LioSamImuOdometry, FailsAndStartsAnewWhenItIsTooFast) {
  const Motion motion;
  ImuOdometryConfig config;
  config.max_speed = 3.0;
  ImuOdometry odometry(config, motion.lever);
  follow(odometry, motion, 0, 3 * kSecond, [](const StampedPose&) {});
  ASSERT_TRUE(odometry.failures().empty());
  Time stamp = 3 * kSecond;
  for (int scan = 0; scan < 4 && odometry.failures().empty(); ++scan) {
    for (int i = 0; i < 40; ++i) (void)odometry.add(motion.sample(stamp += kPeriod));
    Pose wrong = Motion::pose(to_seconds(stamp));
    wrong.translation.y() += 3.0 * (scan + 1);
    odometry.correct({stamp, wrong, false});
  }
  EXPECT_EQ(odometry.failures().at("odometry.speed"), 1);
  EXPECT_FALSE(odometry.add(motion.sample(stamp += kPeriod))) << "no pose until it is solved again";
  follow(odometry, motion, stamp, stamp + 2 * kSecond, [](const StampedPose&) {});
  EXPECT_TRUE(odometry.add(motion.sample(stamp + 2 * kSecond + kPeriod)));
  EXPECT_EQ(odometry.failures().size(), 1U);
}

TEST(LioSamImuOdometry, FailsOnAGreatBias) {
  Motion motion;
  motion.bias.accelerometer = {2.5, 0.0, 0.0};
  ImuOdometryConfig config;
  config.prior_bias_sigma = 10.0;
  config.rotation_sigma = 1e-3;
  config.position_sigma = 1e-3;
  ImuOdometry odometry(config, motion.lever);
  follow(odometry, motion, 0, 5 * kSecond, [](const StampedPose&) {});
  ASSERT_TRUE(odometry.failures().contains("odometry.bias"));
}

TEST(LioSamImuOdometry, SurvivesScansWithoutSamplesAndPosesThatAreNoNumbers) {
  const Motion motion;
  ImuOdometry odometry(ImuOdometryConfig(), motion.lever);
  follow(odometry, motion, 0, kSecond, [](const StampedPose&) {});
  (void)odometry.add(motion.sample(kSecond + kPeriod));
  odometry.correct({kSecond, Motion::pose(1.0), false});
  odometry.correct({kSecond, Motion::pose(1.0), false});  // no samples since the last one
  EXPECT_EQ(odometry.failures().at("odometry.unsolved"), 1);
  Pose broken = Motion::pose(1.0);
  broken.translation.x() = std::nan("");
  odometry.correct({kSecond, broken, false});
  follow(odometry, motion, kSecond + kPeriod, 4 * kSecond, [](const StampedPose&) {});
  EXPECT_TRUE(odometry.add(motion.sample(4 * kSecond + kPeriod)));
  EXPECT_TRUE(odometry.state().velocity.allFinite());
}

}  // namespace
}  // namespace aims::lio_sam
