// SPDX-License-Identifier: BSD-3-Clause
#include "estimator/baselines/lins/robocentric_odometry.hpp"

#include <gtest/gtest.h>

#include <functional>

#include "tests/estimator/baselines/room_scan.hpp"

namespace aims::lins {
namespace {

using aims::testing::pose_of;
using aims::testing::position_error;
using aims::testing::rotation_error;
using Outcome = OdometryResult::Outcome;

constexpr Duration kPeriod = 100 * kMillisecond;

/// A LiDAR that moves by the same motion in each scan, and its IMU without errors.
class LinsOdometryInARoom : public ::testing::Test {
 protected:
  static Config measured_times() {
    Config config;
    config.features.point_times = lego_loam::PointTimes::kMeasured;
    config.filter.predict_until = PredictionEnd::kScanEnd;
    return config;
  }

  /// Samples at 200 Hz over a scan, level.
  std::vector<ImuSample> samples(Time end, const Pose& motion) const {
    std::vector<ImuSample> all;
    const Eigen::Vector3d rate = so3_log(motion.rotation) / 0.1;
    for (Time stamp = end - kPeriod; stamp <= end; stamp += 5 * kMillisecond) {
      all.push_back({stamp, rate, acceleration_ + kGravity * Eigen::Vector3d::UnitZ()});
    }
    return all;
  }

  OdometryResult next_scan(RobocentricOdometry& odometry, const Pose& motion) {
    const LidarScan scan =
        aims::testing::scan_in(room_, T_world_lidar_, motion, {.noise = 0.005, .seed = ++scans_});
    const Config config = measured_times();
    lego_loam::SegmentedFeatures features = lego_loam::segmented_features(
        lego_loam::RangeImage(scan, config.image), config.image, config.features);
    T_world_lidar_ = T_world_lidar_ * motion;
    const Time end = static_cast<Time>(scans_) * kPeriod;
    const std::vector<ImuSample> imu =
        change_ ? change_(samples(end, motion)) : samples(end, motion);
    return odometry.update(features.features, imu, imu.back(), end);
  }

  aims::test::CorridorShape room_ = aims::testing::room(12.0, 9.0, 4.0);
  Pose T_world_lidar_{Eigen::Quaterniond::Identity(), {0.3, -0.4, 0.6}};
  std::uint64_t scans_ = 0;
  Eigen::Vector3d acceleration_ = Eigen::Vector3d::Zero();
  std::function<std::vector<ImuSample>(std::vector<ImuSample>)> change_;
};

const Pose kMotion = pose_of({0.06, 0.02, 0.0}, {0.0, 0.0, 0.02});

TEST_F(LinsOdometryInARoom, StartsFromTwoScansAndFollowsTheMotion) {
  RobocentricOdometry odometry(measured_times());
  EXPECT_EQ(next_scan(odometry, Pose()).outcome, Outcome::kStarting);
  EXPECT_EQ(next_scan(odometry, Pose()).outcome, Outcome::kStarted);
  const Pose T_true_estimated = T_world_lidar_.inverse() * odometry.pose();
  acceleration_ = {0.8, 0.3, 0.0};
  for (int i = 0; i < 8; ++i) {
    const double begin = 0.1 * i;
    const Eigen::Vector3d moved = (0.1 * begin + 0.005) * acceleration_;
    EXPECT_EQ(next_scan(odometry, {Eigen::Quaterniond::Identity(), moved}).outcome,
              Outcome::kUpdated);
  }
  const Pose expected = T_world_lidar_ * T_true_estimated;
  EXPECT_LT(position_error(odometry.pose(), expected), 0.03) << "seeds 1 to 10";
  EXPECT_LT(rotation_error(odometry.pose(), expected), 0.02);
  EXPECT_LT((odometry.belief().state.velocity - 0.8 * acceleration_).norm(), 0.1);
}

TEST_F(LinsOdometryInARoom, EachScanBeginsAtNoMotionWithoutUncertainty) {
  RobocentricOdometry odometry(measured_times());
  for (int i = 0; i < 4; ++i) next_scan(odometry, kMotion);
  const Belief& belief = odometry.belief();
  EXPECT_EQ(belief.state.motion.translation, Eigen::Vector3d::Zero());
  EXPECT_EQ(part(belief.covariance, Error::kPosition, Error::kPosition).norm(), 0.0);
  EXPECT_EQ(part(belief.covariance, Error::kRotation, Error::kRotation).norm(), 0.0);
  EXPECT_GT(part(belief.covariance, Error::kVelocity, Error::kVelocity).norm(), 0.0);
  EXPECT_NEAR(belief.state.gravity.norm(), kGravity, 1e-12);
}

TEST_F(LinsOdometryInARoom, TheGyroscopeRuleOverTheRotation) {
  RobocentricOdometry odometry(measured_times());
  for (int i = 0; i < 3; ++i) next_scan(odometry, Pose());
  const Pose before = odometry.pose();
  change_ = [](std::vector<ImuSample> imu) {
    for (ImuSample& sample : imu) sample.angular_velocity.z() += 0.1;
    return imu;
  };
  next_scan(odometry, Pose());
  // Its noise is far below that of the features: a rate of 0.1 rad/s is believed for the most part.
  EXPECT_NEAR(yaw_of(before.rotation.conjugate() * odometry.pose().rotation), 0.01, 0.005);
}

TEST_F(LinsOdometryInARoom, GravityGivesRollAndPitch) {
  RobocentricOdometry odometry(measured_times());
  next_scan(odometry, Pose());
  change_ = [](std::vector<ImuSample> imu) {
    imu.back().specific_force = so3_exp({0.05, 0.0, 0.0}).conjugate() * imu.back().specific_force;
    return imu;
  };
  next_scan(odometry, Pose());
  EXPECT_LT(so3_log(odometry.pose().rotation.conjugate() * so3_exp({0.05, 0.0, 0.0})).norm(), 0.01);
  change_ = nullptr;
  next_scan(odometry, Pose());
  const Eigen::Quaterniond level =
      levelled(odometry.pose().rotation, odometry.belief().state.gravity);
  EXPECT_LT(so3_log(odometry.pose().rotation.conjugate() * level).norm(), 1e-12);
  EXPECT_LT(so3_log(odometry.pose().rotation).head<2>().norm(), 0.02);  // no more the one sample
}

// Any change is a divergence with a ratio this small.
TEST_F(LinsOdometryInARoom, AfterADivergenceTheScansAloneGiveTheMotion) {
  Config config = measured_times();
  config.update.divergence_ratio = 1e-6;
  config.update.convergence = 0.0;
  RobocentricOdometry odometry(config);
  for (int i = 0; i < 2; ++i) next_scan(odometry, Pose());
  const Pose before = odometry.pose();
  const OdometryResult result = next_scan(odometry, kMotion);
  EXPECT_EQ(result.outcome, Outcome::kRegistered);
  EXPECT_TRUE(result.update.diverged);
  // 1 - 0.95^30 of the motion, which the IMU did not show.
  const Pose moved = before.inverse() * odometry.pose();
  EXPECT_NEAR(moved.translation.head<2>().norm() / kMotion.translation.norm(), 0.785, 0.25);
  EXPECT_EQ(odometry.belief().state.velocity.norm(), result.update.belief.state.velocity.norm());
}

TEST_F(LinsOdometryInARoom, AResultThatIsNotFiniteIsRejectedAndTheFilterStartsAgain) {
  RobocentricOdometry odometry(measured_times());
  for (int i = 0; i < 3; ++i) next_scan(odometry, Pose());
  const Pose before = odometry.pose();
  change_ = [](std::vector<ImuSample> imu) {
    for (ImuSample& sample : imu) sample.specific_force.x() = 1e300;
    return imu;
  };
  EXPECT_EQ(next_scan(odometry, Pose()).outcome, Outcome::kRejected);
  EXPECT_EQ(odometry.pose().translation, before.translation);
  change_ = nullptr;
  EXPECT_EQ(next_scan(odometry, Pose()).outcome, Outcome::kStarting);
  EXPECT_EQ(next_scan(odometry, Pose()).outcome, Outcome::kStarted);
  EXPECT_EQ(next_scan(odometry, Pose()).outcome, Outcome::kUpdated);
  EXPECT_LT(position_error(odometry.pose(), before), 0.05);
}

TEST_F(LinsOdometryInARoom, TooFewFeaturesLeaveThePredictionRunning) {
  Config config = measured_times();
  config.min_features.edges = 1000000;
  RobocentricOdometry odometry(config);
  for (int i = 0; i < 2; ++i) next_scan(odometry, Pose());
  const Pose before = odometry.pose();
  EXPECT_EQ(next_scan(odometry, kMotion).outcome, Outcome::kUnchanged);
  EXPECT_EQ(odometry.pose().translation, before.translation);
  EXPECT_GT(so3_log(odometry.belief().state.motion.rotation).z(), 0.015);  // predicted
}

}  // namespace
}  // namespace aims::lins
