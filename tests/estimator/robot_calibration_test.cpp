// SPDX-License-Identifier: BSD-3-Clause
#include "estimator/robot_calibration.hpp"

#include <gtest/gtest.h>

#include <fstream>
#include <string>

#include "estimator/aims/robot_prior.hpp"
#include "tests/support/temporary_folder.hpp"

namespace aims {
namespace {

RobotCalibration some_robot() {
  RobotCalibration calibration;
  calibration.estimator = "aims_d";
  calibration.recordings = {"hall, first.bag", "yard.bag"};
  calibration.sensors.legs = {0.19, 0.05, 0.08, 0.21, 0.22, 0.02};
  calibration.sensors.imu_rate = 200.0;
  CalibratedQuantity mount;
  mount.name = "lidar_mount";
  mount.entries = {"x [rad]", "y [rad]", "z [rad]"};
  mount.values = {0.001, -0.002, 1.0 / 3.0};
  mount.covariance = {1e-6, 0.0, 0.0, 1e-6, 2e-7, 1e-6};
  mount.sigma = {1e-3, 1e-3, 1e-3};
  mount.prior_sigma = {5e-3, 5e-3, 5e-3};
  mount.verdict = {kObservable, kObservable, kNotObservable};
  mount.used = true;
  calibration.quantities = {mount};
  return calibration;
}

class RobotCalibrationFile : public ::testing::Test {
 protected:
  std::filesystem::path written(const std::string& text) const {
    const auto file = folder_.path() / "robot.yaml";
    std::ofstream(file) << text;
    return file;
  }
  std::string error_of(const RobotCalibration& calibration) const {
    const auto read = read_robot_calibration(written(text_of(calibration)));
    return read ? "" : read.error().message;
  }
  TemporaryFolder folder_;
};

TEST_F(RobotCalibrationFile, IsReadBackAsItWasWritten) {
  const RobotCalibration robot = some_robot();
  const auto again = read_robot_calibration(written(text_of(robot)));
  ASSERT_TRUE(again) << again.error().message;
  EXPECT_EQ(text_of(*again), text_of(robot));
  EXPECT_EQ(again->recordings, robot.recordings);
  EXPECT_EQ(again->quantities.front().values, robot.quantities.front().values);
  EXPECT_EQ(again->sensors.legs, robot.sensors.legs);
}

TEST_F(RobotCalibrationFile, WhatIsNoneIsRefusedWithTheReason) {
  EXPECT_EQ(error_of(some_robot()), "");
  RobotCalibration other = some_robot();
  other.schema = "aims.run/1";
  EXPECT_NE(error_of(other).find("expected aims.robot_calibration/1"), std::string::npos);
  RobotCalibration negative = some_robot();
  negative.quantities[0].covariance[0] = -1.0;
  EXPECT_NE(error_of(negative).find("quantities.0: lidar_mount: expected 3 values"),
            std::string::npos)
      << error_of(negative);
  RobotCalibration unknown = some_robot();
  unknown.quantities[0].name = "mass";
  EXPECT_NE(error_of(unknown).find("name 'mass'"), std::string::npos) << error_of(unknown);
  const auto scenario = read_robot_calibration(written("scene: {kind: corridor}\n"));
  ASSERT_FALSE(scenario);
  EXPECT_NE(scenario.error().message.find("scene"), std::string::npos);
}

TEST(RobotCalibration, BecomesSettingsOfWhatIsUsed) {
  RobotCalibration robot = some_robot();
  const auto settings = prior_settings(robot, "a.yaml");
  ASSERT_EQ(settings.size(), 3U);
  EXPECT_EQ(settings[1], "estimators.*.prior.file=a.yaml");
  EXPECT_EQ(settings[2].find("estimators.*.prior.lidar_mount=[0.001, -0.002, 0.333"), 0U);
  robot.quantities[0].used = false;
  EXPECT_TRUE(prior_settings(robot, "a.yaml").empty());
}

TEST(RobotCalibration, AnotherRobotIsNoticed) {
  const CalibratedSensors one = some_robot().sensors;
  EXPECT_TRUE(misfits(one, one).empty());
  CalibratedSensors other = one;
  other.legs.calf += 0.02;
  other.lidar_translation.x() += 0.1;
  other.imu_rate = 50.0;
  EXPECT_EQ(misfits(one, other).size(), 3U);
  other = one;
  other.topics = {"/points"};
  EXPECT_TRUE(misfits(one, other).empty()) << "simulated sequences have no topics";
}

TEST(RobotCalibration, ARecordingWithoutALidarFitsAndHasNoMount) {
  CalibratedSensors calibrated = some_robot().sensors;
  calibrated.lidar_translation.x() = 0.2;
  calibrated.topics = {"/points", "/imu", "/odom"};
  CalibratedSensors without = some_robot().sensors;
  without.topics = {"/imu"};
  without.has_lidar = false;
  EXPECT_TRUE(misfits(calibrated, without).empty());
  without.topics = {"/imu_2"};
  EXPECT_EQ(misfits(calibrated, without).size(), 1U);
}

TEST_F(RobotCalibrationFile, LegsThatNoRobotHasAreRefused) {
  RobotCalibration robot = some_robot();
  CalibratedQuantity& legs = robot.quantities.front();
  legs.name = "legs_by_feet";
  legs.values = {0.2, 0.0, 0.0, 0.0, 0.0, 0.0};
  legs.covariance.clear();
  for (int row = 0; row < 6; ++row) {
    for (int column = row; column < 6; ++column) {
      legs.covariance.push_back(row == column ? 1e-8 : 0.0);
    }
  }
  EXPECT_NE(error_of(robot).find("legs_by_feet: scale x of 0.2: expected at most 0.16"),
            std::string::npos)
      << error_of(robot);
  legs.values[0] = 0.1;
  EXPECT_EQ(error_of(robot), "");
  legs.covariance[0] = 1e12;
  EXPECT_NE(error_of(robot).find("robot.yaml:"), std::string::npos) << error_of(robot);
  EXPECT_NE(error_of(robot).find("covariance"), std::string::npos) << error_of(robot);
}

// What estimators start from: the values, with their covariance and no other correlation.
TEST(RobotPrior, ReplacesTheEntriesOfTheBelief) {
  Belief belief;
  const Gaussian mount{Eigen::Vector3d(0.01, -0.02, 0.03), 1e-6 * Eigen::Matrix3d::Identity()};
  const Belief known = with_entries(belief, ErrorState::kMount.offset, mount);
  EXPECT_LT((so3_log(known.state.mount) - mount.mean).norm(), 1e-12);
  EXPECT_EQ((block(known.covariance, ErrorState::kMount, ErrorState::kMount)), mount.covariance);
}

TEST(RobotPrior, ACovarianceOfTheWrongSizeIsAnError) {
  RobotPriorConfig config;
  config.enabled = true;
  config.imu_delay = {0.001, 1e-6};
  EXPECT_TRUE(check(config));
  config.gyro_bias = {0.0, 0.0, 0.0};
  const auto checked = check(config);
  ASSERT_FALSE(checked);
  EXPECT_NE(checked.error().message.find("prior.gyro_bias: expected 3 values"), std::string::npos);
}

}  // namespace
}  // namespace aims
