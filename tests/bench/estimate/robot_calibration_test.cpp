// SPDX-License-Identifier: BSD-3-Clause
#include "bench/estimate/robot_calibration.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace aims {
namespace {

/// A run whose data show `value` with the deviation `sigma`, of a quantity known to 1.
CalibrationRun run(const std::string& name, double value, double sigma, bool varies = false) {
  LearnedQuantity quantity;
  quantity.name = "imu_delay";
  quantity.entries = {"delay [s]"};
  quantity.information = Eigen::MatrixXd::Constant(1, 1, 1.0 / (sigma * sigma));
  quantity.vector = Eigen::VectorXd::Constant(1, value / (sigma * sigma));
  quantity.prior = Eigen::VectorXd::Zero(1);
  quantity.prior_sigma = Eigen::VectorXd::Ones(1);
  quantity.varies_by_run = varies;
  return {name, {}, {quantity}};
}

CalibratedQuantity of(std::vector<CalibrationRun> runs) {
  return combined(runs, "aims_d").quantities.front();
}

TEST(CombinedCalibration, WeighsRunsByTheirInformation) {
  const CalibratedQuantity found = of({run("a", 0.10, 0.01), run("b", 0.13, 0.02)});
  const double information = 1.0 / 1e-4 + 1.0 / 4e-4 + 1.0;
  EXPECT_NEAR(found.values[0], (0.10 / 1e-4 + 0.13 / 4e-4) / information, 1e-12);
  EXPECT_NEAR(found.covariance[0], 1.0 / information, 1e-15);
  EXPECT_EQ(found.degrees_of_freedom, 1);
  EXPECT_NEAR(found.chi_square, 0.03 * 0.03 / 5e-4, 1e-6);
  EXPECT_EQ(found.inflation, 1.0);
  EXPECT_EQ(found.verdict[0], kObservable);
  EXPECT_TRUE(found.used);
}

TEST(CombinedCalibration, RunsThatDisagreeInflateTheCovarianceAndItIsSaid) {
  const std::vector<CalibrationRun> runs = {run("a", 0.10, 0.01), run("b", 0.20, 0.01)};
  const RobotCalibration calibration = combined(runs, "aims_d");
  const CalibratedQuantity& found = calibration.quantities.front();
  EXPECT_NEAR(found.chi_square, 0.1 * 0.1 / 2e-4, 1e-6);
  EXPECT_NEAR(found.inflation, 50.0, 1e-6);
  EXPECT_NEAR(found.covariance[0], 0.5e-4 * 50.0, 1e-4);
  const auto warnings = warnings_of(calibration, runs);
  ASSERT_EQ(warnings.size(), 1U);
  EXPECT_NE(warnings[0].find("the recordings disagree"), std::string::npos);
}

TEST(CombinedCalibration, WhatTheDataDoNotShowIsNotObservable) {
  const CalibratedQuantity found = of({run("a", 0.1, 2.0)});
  EXPECT_EQ(found.verdict[0], kNotObservable);
  EXPECT_FALSE(found.used);
}

TEST(CombinedCalibration, WhatVariesByRunIsKnownByTheSpreadOfThree) {
  EXPECT_FALSE(of({run("a", 0.1, 0.01, true), run("b", 0.1, 0.01, true)}).used);
  const CalibratedQuantity found =
      of({run("a", 0.1, 1e-6, true), run("b", 0.2, 1e-6, true), run("c", 0.3, 1e-6, true)});
  EXPECT_TRUE(found.used);
  EXPECT_NEAR(found.values[0], 0.2, 1e-6);
  // The variance of a further run about the mean of three: s^2 (1 + 1/3).
  EXPECT_NEAR(found.covariance[0], 0.01 * 4.0 / 3.0, 1e-6);
}

// Two runs with other turn-on biases do not make them known better than one.
TEST(CombinedCalibration, WhatVariesByRunIsNotKnownBetterFromTwoRuns) {
  const CalibratedQuantity found = of({run("a", 0.1, 1e-3, true), run("b", 0.2, 1e-3, true)});
  EXPECT_NEAR(found.values[0], 0.15, 1e-6);
  EXPECT_GT(found.sigma[0], 0.08);
  EXPECT_FALSE(found.used);
}

TEST(CombinedCalibration, ARunOfAnotherRobotIsRefusedAndOneOfOtherRatesAWarning) {
  std::vector<CalibrationRun> runs = {run("a", 0.1, 0.01), run("b", 0.1, 0.01)};
  EXPECT_TRUE(check_one_robot(runs));
  runs[0].sensors.imu_rate = 200.0;
  runs[1].sensors.imu_rate = 400.0;
  EXPECT_TRUE(check_one_robot(runs));
  const auto warnings = warnings_of(combined(runs, "aims_d"), runs);
  ASSERT_EQ(warnings.size(), 1U);
  EXPECT_NE(warnings[0].find("b differs from a: an IMU of 400"), std::string::npos);
  runs[1].sensors.legs.calf = 0.3;
  const auto checked = check_one_robot(runs);
  ASSERT_FALSE(checked);
  EXPECT_NE(checked.error().message.find("b is not of the robot of a"), std::string::npos);
}

TEST(CombinedCalibration, NothingLearnedIsAWarning) {
  const std::vector<CalibrationRun> runs = {run("a", 0.1, 2.0)};
  const auto warnings = warnings_of(combined(runs, "aims_d"), runs);
  ASSERT_EQ(warnings.size(), 1U);
  EXPECT_NE(warnings[0].find("nothing of the robot was learned"), std::string::npos);
}

TEST(CombinedCalibration, LegsThatNoRobotHasAreNotUsedAndItIsSaid) {
  CalibrationRun wrong = run("a", 0.2, 0.01);
  LearnedQuantity& legs = wrong.learned.front();
  legs.name = "legs_by_feet";
  const std::vector<CalibrationRun> runs = {wrong};
  const RobotCalibration calibration = combined(runs, "aims_d");
  EXPECT_FALSE(calibration.quantities.front().used);
  const auto warnings = warnings_of(calibration, runs);
  ASSERT_FALSE(warnings.empty());
  EXPECT_NE(warnings[0].find("scale x of 0.2: expected at most 0.16"), std::string::npos)
      << warnings[0];
}

// Their scale is that of the place where it was found, also where the compliance is known well.
TEST(CombinedCalibration, TheScaleOfLegsOnSoftJointsIsNotUsed) {
  const auto with_compliance = [](double value, double sigma) {
    CalibrationRun robot = run("a", 0.03, 0.01);
    robot.learned.front().name = "legs_by_feet";
    LearnedQuantity joints = run("a", value, sigma).learned.front();
    joints.name = "joint_compliance";
    joints.prior_sigma = Eigen::VectorXd::Constant(1, 0.4);
    robot.learned.push_back(joints);
    return combined(std::vector{robot}, "aims_d").quantities;
  };
  for (const double sigma : {0.3, 0.1}) {
    const auto soft = with_compliance(2.0, sigma);
    EXPECT_EQ(soft.back().verdict[0], sigma < 0.2 ? kObservable : kNotObservable);
    EXPECT_FALSE(soft.front().used);
    EXPECT_NE(soft.front().note.find("the joints are soft"), std::string::npos)
        << soft.front().note;
    EXPECT_TRUE(with_compliance(0.5, sigma).front().used);
  }
}

// Their disagreement is in the file; nothing starts from them.
TEST(CombinedCalibration, WhatIsOnlyStatedIsNoWarningWhereRunsDisagree) {
  std::vector<CalibrationRun> runs = {run("a", 0.10, 0.01), run("b", 0.20, 0.01)};
  for (CalibrationRun& each : runs) {
    each.learned.push_back(each.learned.front());
    each.learned.back().name = "joint_delay";
  }
  const auto warnings = warnings_of(combined(runs, "aims_d"), runs);
  ASSERT_EQ(warnings.size(), 1U);
  EXPECT_NE(warnings[0].find("imu_delay"), std::string::npos);
}

}  // namespace
}  // namespace aims
