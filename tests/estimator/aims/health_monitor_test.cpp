// SPDX-License-Identifier: BSD-3-Clause
#include "estimator/aims/health_monitor.hpp"

#include <gtest/gtest.h>

#include <algorithm>

namespace aims {
namespace {

const HealthEstimate kStill = {Eigen::Vector3d::Zero(), 0.0, 0.01};

/// Ten seconds in which everything arrives as it should.
InputMonitor good_inputs() {
  InputMonitor inputs;
  for (int i = 0; i < 1000; ++i) {
    const Time now = i * 10 * kMillisecond;
    inputs.accepted(Sensor::kImu, now);
    inputs.accepted_force({0.0, 0.0, 9.81});
    inputs.accepted(Sensor::kLegs, now);
    if (i % 10 == 0) inputs.accepted(Sensor::kLidar, now);
  }
  return inputs;
}
constexpr Time kNow = 10 * kSecond;

HealthMonitor full_monitor() { return {{.lidar = true, .legs = true, .imu = true}, 9.81}; }

ScanDiagnostics good_scan() {
  ScanDiagnostics scan;
  scan.iterations = 3;
  scan.points_used = 800;
  scan.innovation_rotation.setConstant(1e-3);
  scan.weak_tilt = 0.1;
  return scan;
}

bool has(const HealthRow& row, const std::string& reason) {
  return std::ranges::any_of(row.reasons,
                             [&](const auto& each) { return each.find(reason) != each.npos; });
}

TEST(HealthMonitor, IsHealthyWhenEverythingAgrees) {
  HealthMonitor monitor = full_monitor();
  for (int i = 0; i < 100; ++i) monitor.scan(good_scan(), 1000);
  const HealthRow row = monitor.judge(kNow, good_inputs(), kStill);
  EXPECT_EQ(row.state, HealthState::kHealthy);
  EXPECT_TRUE(row.reasons.empty());
}

TEST(HealthMonitor, StartsAndThenMissesAnImuThatNeverCame) {
  InputMonitor inputs;
  inputs.accepted(Sensor::kLidar, 0);
  HealthMonitor monitor = full_monitor();
  EXPECT_EQ(monitor.judge(kSecond, inputs, std::nullopt).state, HealthState::kStarting);
  const HealthRow late = monitor.judge(4 * kSecond, inputs, std::nullopt);
  EXPECT_EQ(late.state, HealthState::kInvalid);
  EXPECT_TRUE(has(late, "no IMU data"));
}

TEST(HealthMonitor, NamesASilentSensor) {
  const auto after = [](Duration silence) {
    HealthMonitor monitor = full_monitor();
    InputMonitor inputs = good_inputs();
    inputs.accepted(Sensor::kImu, kNow + silence);
    inputs.accepted(Sensor::kLidar, kNow + silence);
    return monitor.judge(kNow + silence, inputs, kStill);
  };
  EXPECT_EQ(after(300 * kMillisecond).state, HealthState::kHealthy);
  EXPECT_EQ(after(kSecond).state, HealthState::kDegraded);
  EXPECT_TRUE(has(after(kSecond), "no leg odometry"));
}

TEST(HealthMonitor, IsInvalidWhenNothingCorrects) {
  HealthMonitor monitor = full_monitor();
  InputMonitor inputs = good_inputs();
  inputs.accepted(Sensor::kImu, kNow + 6 * kSecond);
  const HealthRow row = monitor.judge(kNow + 6 * kSecond, inputs, kStill);
  EXPECT_EQ(row.state, HealthState::kInvalid);
  EXPECT_TRUE(has(row, "neither LiDAR nor legs"));
}

TEST(HealthMonitor, KnowsAForceInWrongUnits) {
  HealthMonitor monitor = full_monitor();
  InputMonitor inputs = good_inputs();
  for (int i = 0; i < 1000; ++i) inputs.accepted_force({0.0, 0.0, 1.0});
  const HealthRow row = monitor.judge(kNow, inputs, kStill);
  EXPECT_EQ(row.state, HealthState::kInvalid);
  EXPECT_TRUE(has(row, "mean specific force 1.0"));
}

TEST(HealthMonitor, CountsRejectedMeasurements) {
  HealthMonitor monitor = full_monitor();
  InputMonitor inputs = good_inputs();
  for (int i = 0; i < 40; ++i) {
    if (i % 4 == 0) {
      inputs.accepted(Sensor::kLegs, kNow);
    } else {
      inputs.rejected(Sensor::kLegs, kNow);
    }
  }
  EXPECT_TRUE(has(monitor.judge(kNow, inputs, kStill), "leg odometry rejected"));
}

TEST(HealthMonitor, NoticesLegsThatDisagreeForLong) {
  HealthMonitor monitor = full_monitor();
  monitor.leg_residual({0.5, 0.0, 0.0});  // one sample: a slip
  EXPECT_EQ(monitor.judge(kNow, good_inputs(), kStill).state, HealthState::kHealthy);
  for (int i = 0; i < 400; ++i) monitor.leg_residual({0.3, 0.0, 0.0});
  EXPECT_EQ(monitor.judge(kNow, good_inputs(), kStill).state, HealthState::kDegraded);
  for (int i = 0; i < 1000; ++i) monitor.leg_residual({1.4, 0.0, 0.0});
  EXPECT_EQ(monitor.judge(kNow, good_inputs(), kStill).state, HealthState::kInvalid);
}

TEST(HealthMonitor, NoticesScansThatDoNotMatchAndTheirReturn) {
  HealthMonitor monitor = full_monitor();
  for (int i = 0; i < 6; ++i) monitor.scan({}, 1000);
  EXPECT_TRUE(has(monitor.judge(kNow, good_inputs(), kStill), "do not match"));
  for (int i = 0; i < 60; ++i) monitor.scan(good_scan(), 1000);
  EXPECT_EQ(monitor.judge(kNow, good_inputs(), kStill).state, HealthState::kHealthy);
}

TEST(HealthMonitor, NoticesScansThatContradictThePrediction) {
  HealthMonitor monitor = full_monitor();
  ScanDiagnostics scan = good_scan();
  scan.innovation_rotation << 0.0, 0.0, 0.1;
  for (int i = 0; i < 30; ++i) monitor.scan(scan, 1000);
  EXPECT_TRUE(has(monitor.judge(kNow, good_inputs(), kStill), "predicted rotation"));
}

TEST(HealthMonitor, RefusesASpeedThatNoRobotWalks) {
  HealthMonitor monitor = full_monitor();
  const HealthRow row = monitor.judge(kNow, good_inputs(), HealthEstimate{{}, 40.0, 0.01});
  EXPECT_EQ(row.state, HealthState::kInvalid);
}

TEST(HealthMonitor, HoldsTheStatedDeviationAgainstTheLimitOfASuccess) {
  const auto state_at = [](double sigma) {
    HealthMonitor monitor = full_monitor();
    const HealthEstimate estimate = {Eigen::Vector3d::Zero(), 0.0, sigma};
    return monitor.judge(kNow, good_inputs(), estimate).state;
  };
  EXPECT_EQ(state_at(0.4), HealthState::kHealthy);
  EXPECT_EQ(state_at(0.6), HealthState::kDegraded);
  EXPECT_EQ(state_at(1.1), HealthState::kInvalid);
}

TEST(HealthMonitor, NamesSoftJointsOnceTheyMayCostTheSuccess) {
  const auto row_at = [](double sigma, double tilt = 0.003) {
    HealthMonitor monitor = full_monitor();
    ScanDiagnostics scan = good_scan();
    scan.weak_tilt = tilt;
    for (int i = 0; i < 100; ++i) monitor.scan(scan, 1000);
    HealthEstimate estimate = kStill;
    estimate.soft_leg_sigma = sigma;
    return monitor.judge(kNow, good_inputs(), estimate);
  };
  EXPECT_EQ(row_at(0.045).state, HealthState::kHealthy);
  EXPECT_EQ(row_at(0.06).state, HealthState::kDegraded);
  EXPECT_TRUE(has(row_at(0.06), "soft joints make the distance uncertain"));
  EXPECT_EQ(row_at(0.06, 0.05).state, HealthState::kHealthy) << "scans hold the way";
  EXPECT_EQ(row_at(0.3).state, HealthState::kDegraded) << "a bound makes no estimate invalid";
}

TEST(HealthMonitor, DoesNotMissWhatTheEstimatorDoesNotUse) {
  HealthMonitor legs_alone({.legs = true}, 9.81);
  InputMonitor inputs;
  inputs.accepted(Sensor::kLegs, 0);
  inputs.accepted(Sensor::kLegs, 20 * kSecond);
  EXPECT_EQ(legs_alone.judge(20 * kSecond, inputs, kStill).state, HealthState::kHealthy);
}

TEST(Health, RowsAreKeptOnChangeAndOncePerSecond) {
  std::vector<HealthRow> rows;
  for (int i = 0; i < 30; ++i) {
    append_health(rows, {i * 100 * kMillisecond, HealthState::kHealthy, {}, 0.0});
  }
  EXPECT_EQ(rows.size(), 3U);
  append_health(rows, {2950 * kMillisecond, HealthState::kDegraded, {"no leg odometry"}, 0.0});
  EXPECT_EQ(rows.size(), 4U);
}

}  // namespace
}  // namespace aims
