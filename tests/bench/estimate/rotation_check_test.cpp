// SPDX-License-Identifier: BSD-3-Clause
#include "bench/estimate/rotation_check.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

#include "core/lie.hpp"

namespace aims {
namespace {

constexpr double kQuarter = std::numbers::pi / 2.0;

/// Rotations of a walk, in the IMU frame and by a LiDAR of the mount, with noise of 4 mrad.
std::vector<RotationPair> rotations(const Eigen::Matrix3d& R_imu_lidar, bool about_all_axes) {
  std::mt19937 random(11);
  std::normal_distribution<double> turn(0.0, 0.1), noise(0.0, 0.004);
  std::vector<RotationPair> pairs;
  for (int i = 0; i < 100; ++i) {
    const double rocking = about_all_axes ? 1.0 : 0.0;
    RotationPair pair;
    pair.imu = {rocking * turn(random), rocking * turn(random), 0.1 + turn(random)};
    pair.lidar = R_imu_lidar.transpose() * pair.imu +
                 Eigen::Vector3d(noise(random), noise(random), noise(random));
    pairs.push_back(pair);
  }
  return pairs;
}

const Eigen::Quaterniond kMount = yaw_rotation(0.6) * so3_exp(Eigen::Vector3d(0.0, 0.4, 0.0));

TEST(MountCheck, ARightMountIsNotContradicted) {
  const MountCheck check = check_mount(rotations(kMount.toRotationMatrix(), true), kMount);
  EXPECT_FALSE(check.contradicts);
  EXPECT_EQ(check.intervals, 100);
  EXPECT_LT(check.given_residual, 0.05);
  EXPECT_TRUE(check.cause.empty());
}

TEST(MountCheck, AnInvertedExtrinsicIsFound) {
  const Eigen::Quaterniond mount = yaw_rotation(0.9) * so3_exp(Eigen::Vector3d(0.0, 1.1, 0.0));
  const MountCheck check =
      check_mount(rotations(mount.toRotationMatrix(), true), mount.conjugate());
  EXPECT_TRUE(check.contradicts);
  EXPECT_EQ(check.cause, "the extrinsic is inverted");
  EXPECT_LT(check.R_imu_lidar.angularDistance(mount), 1e-6);
}

TEST(MountCheck, TurnsByRightAnglesAndAnUpsideDownImuAreFound) {
  for (const Eigen::Vector3d& turn :
       {Eigen::Vector3d(2.0 * kQuarter, 0, 0), Eigen::Vector3d(0, kQuarter, 0),
        Eigen::Vector3d(0, 0, -kQuarter), Eigen::Vector3d(0, 0, 2.0 * kQuarter)}) {
    const Eigen::Quaterniond truly = so3_exp(turn) * kMount;
    const MountCheck check = check_mount(rotations(truly.toRotationMatrix(), true), kMount);
    EXPECT_TRUE(check.contradicts) << turn.transpose();
    EXPECT_LT(check.R_imu_lidar.angularDistance(truly), 1e-6) << turn.transpose();
    EXPECT_NE(check.cause.find("degrees about"), std::string::npos) << check.cause;
    const bool about_z = turn.z() > kQuarter;  // gravity does not tell
    EXPECT_EQ(check.cause.find("z of the clouds is mirrored") != std::string::npos, about_z);
  }
}

TEST(MountCheck, AMirroredAxisIsNoMount) {
  Eigen::Matrix3d swapped;
  swapped << 0, 1, 0, 1, 0, 0, 0, 0, 1;
  const MountCheck check =
      check_mount(rotations(swapped * kMount.toRotationMatrix(), true), kMount);
  EXPECT_TRUE(check.contradicts);
  EXPECT_NE(check.cause.find("no mount corrects that"), std::string::npos) << check.cause;
  EXPECT_LT(check.R_imu_lidar.angularDistance(kMount), 1e-9) << "stays as given";
}

TEST(MountCheck, AMountThatIsOffByDegreesIsFoundWithTurnsAboutOneAxis) {
  for (const bool about_all_axes : {false, true}) {
    const Eigen::Quaterniond truly = so3_exp(Eigen::Vector3d(0.0, 0.3, 0.0)) * kMount;
    const MountCheck check =
        check_mount(rotations(truly.toRotationMatrix(), about_all_axes), kMount);
    EXPECT_TRUE(check.contradicts);
    EXPECT_TRUE(check.correctable);
    EXPECT_NE(check.cause.find("the mount is off by 17 degrees about ["), std::string::npos)
        << check.cause;
    EXPECT_LT(check.R_imu_lidar.angularDistance(truly), 0.02);
    EXPECT_EQ(check.one_axis, !about_all_axes);
  }
}

TEST(MountCheck, TheScaleAndTheSignOfEachAxisOfTheGyroAreFound) {
  const std::pair<Eigen::Vector3d, const char*> gyros[] = {
      {{1.0, 1.0, 0.5}, "z of the gyro measures 0.50 times"},
      {{1.0, 1.0, -1.0}, "z of the gyro has the wrong sign"},
      {{1.0, 0.0, 1.0}, "y of the gyro measures nothing"},
      {{57.3, 57.3, 57.3}, "x of the gyro is in deg/s"}};
  for (const auto& [scales, cause] : gyros) {
    std::vector<RotationPair> pairs = rotations(kMount.toRotationMatrix(), true);
    for (RotationPair& each : pairs) each.imu = scales.asDiagonal() * each.imu;
    const MountCheck check = check_mount(pairs, kMount);
    EXPECT_TRUE(check.contradicts) << cause;
    EXPECT_FALSE(check.correctable) << cause;
    EXPECT_NE(check.cause.find(cause), std::string::npos) << check.cause;
    EXPECT_NEAR(check.axes[2].scale, scales.z(), 0.02 * scales.norm());
  }
}

TEST(MountCheck, GravityTellsASignOfTheGyroFromAnImuThatIsUpsideDown) {
  std::vector<RotationPair> pairs = rotations(Eigen::Matrix3d::Identity(), false);
  for (RotationPair& each : pairs) each.imu = -each.imu;
  const Eigen::Quaterniond given = Eigen::Quaterniond::Identity();
  const MountCheck upright = check_mount(pairs, given, Eigen::Vector3d(0.0, 0.1, 9.8));
  EXPECT_EQ(upright.cause, "z of the gyro has the wrong sign");
  const MountCheck overhead = check_mount(pairs, given, Eigen::Vector3d(0.0, 0.1, -9.8));
  EXPECT_NE(overhead.cause.find("turned by 180 degrees"), std::string::npos) << overhead.cause;
}

TEST(MountCheck, GravityTellsMirroredCloudsFromAnImuThatIsUpsideDown) {
  const Eigen::Matrix3d mirror = Eigen::Vector3d(1.0, -1.0, 1.0).asDiagonal();
  std::vector<RotationPair> pairs = rotations(kMount.toRotationMatrix(), true);
  for (RotationPair& each : pairs) each.lidar = -(mirror * each.lidar);
  const MountCheck check = check_mount(pairs, kMount, Eigen::Vector3d(0.0, 0.1, 9.8));
  EXPECT_TRUE(check.contradicts);
  EXPECT_FALSE(check.correctable);
  EXPECT_EQ(check.cause.find("y of the clouds is mirrored"), 0U) << check.cause;
}

TEST(MountCheck, OnlyAxesAboutWhichTheBodyTurnsCountAsChecked) {
  const MountCheck check =
      check_mount(rotations(Eigen::Matrix3d::Identity(), false), Eigen::Quaterniond::Identity());
  EXPECT_FALSE(check.axes[0].observable());
  EXPECT_FALSE(check.axes[1].observable());
  EXPECT_TRUE(check.axes[2].observable());
  EXPECT_NEAR(check.axes[2].scale, 1.0, 0.02);
}

TEST(MountCheck, WhatTurnsAboutOneAxisDoNotShowIsNoContradiction) {
  // Off by a turn about the vertical, which is the axis of every rotation.
  const Eigen::Matrix3d truly = yaw_rotation(kQuarter).toRotationMatrix();
  EXPECT_FALSE(check_mount(rotations(truly, false), Eigen::Quaterniond::Identity()).contradicts);
  EXPECT_FALSE(check_mount({}, kMount).contradicts);
  EXPECT_EQ(check_mount({}, kMount).intervals, 0);
}

/// Rates of a body that turns at random, seen at `rate` Hz by a sensor `late` s behind, in a unit
/// of `scale`.
std::vector<TurnRate> rates(double rate_hz, double late, double scale) {
  std::vector<TurnRate> all;
  for (int i = 0; i < static_cast<int>(60 * rate_hz); ++i) {
    const double t = i / rate_hz;
    const double turn =
        std::sin(0.9 * t) + 0.7 * std::sin(2.3 * t + 1.0) + 0.5 * std::sin(5.1 * t + 2.0);
    all.push_back({from_seconds(t + late), scale * std::abs(0.5 * turn)});
  }
  return all;
}

TEST(RateCheck, AClockThatDiffersIsFound) {
  for (const double late : {-0.2, 0.0, 0.08}) {
    const RateCheck check = check_rates(rates(10.0, late, 1.0), rates(200.0, 0.0, 1.0));
    ASSERT_TRUE(check.clock) << late;
    EXPECT_NEAR(check.clock->seconds, late, 0.005);
    EXPECT_NEAR(check.scale, 1.0, 0.02);
  }
}

TEST(RateCheck, AGyroInDegreesIsFoundAndABodyThatStandsShowsNothing) {
  EXPECT_NEAR(check_rates(rates(10.0, 0.0, 1.0), rates(200.0, 0.0, 57.3)).scale, 57.3, 1.0);
  const RateCheck still = check_rates(rates(10.0, 0.0, 1e-3), rates(200.0, 0.0, 1e-3));
  EXPECT_EQ(still.scale, 0.0);
  EXPECT_FALSE(still.clock);
}

}  // namespace
}  // namespace aims
