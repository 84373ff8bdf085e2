// SPDX-License-Identifier: BSD-3-Clause
#include "estimator/baselines/bievr/inertial_window.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace aims::bievr {
namespace {

/// Intervals of a body that turns and accelerates, with an IMU whose biases are `truth`'s.
struct Drive {
  InertialState truth{
      .bias = {.accelerometer = {0.05, -0.03, 0.02}, .gyro = {0.004, -0.002, 0.003}},
      .up = Eigen::Vector3d(0.02, -0.01, 1.0).normalized()};
  std::vector<Interval> intervals;
  std::vector<NavState> states = {NavState()};

  Drive() {
    for (int k = 0; k < 60; ++k) {
      Interval interval;
      for (int i = 0; i < 20; ++i) {
        const double t = 0.1 * k + 0.005 * i;
        InertialSegment segment;
        segment.begin = from_seconds(t);
        segment.end = from_seconds(t + 0.005);
        segment.angular_velocity = Eigen::Vector3d(0.3 * std::sin(t), 0.4 * std::cos(2.0 * t), 0.5);
        segment.specific_force =
            Eigen::Vector3d(std::sin(3.0 * t), std::cos(t), 9.8 + 0.5 * std::sin(5.0 * t));
        interval.segments.push_back(segment);
      }
      interval.end = interval.segments.back().end;
      interval.motion = preintegrated(interval.segments, truth.bias);
      states.push_back(predicted(states.back(), interval.motion, truth));
      interval.from = states[states.size() - 2].T_map_imu;
      interval.to = states.back().T_map_imu;
      interval.motion = preintegrated(interval.segments, ImuBias());
      intervals.push_back(interval);
    }
  }
};

TEST(InertialWindow, FindsBiasesGravityAndVelocity) {
  const Drive drive;
  InertialConfig config;
  config.gravity_weight = 1e-6;  // the prior is wrong by a degree here
  InertialWindow window(config);
  for (const Interval& each : drive.intervals) window.add(each, Eigen::Vector3d::Zero());
  InertialState x;
  ASSERT_TRUE(window.solve(x));
  EXPECT_LT((x.bias.gyro - drive.truth.bias.gyro).norm(), 2e-5);
  EXPECT_LT((x.bias.accelerometer - drive.truth.bias.accelerometer).norm(), 2e-3);
  EXPECT_LT((x.up - drive.truth.up).norm(), 3e-4);
  EXPECT_LT((window.velocity() - drive.states.back().velocity).norm(), 1e-3);
}

TEST(InertialWindow, TheBeginOfTheWindowIsFixed) {
  const Drive drive;
  InertialConfig config;
  config.window = 3.0;
  config.gravity_weight = 1e-6;
  InertialWindow window(config);
  InertialState x;
  for (const Interval& each : drive.intervals) {
    window.add(each, Eigen::Vector3d::Zero());
    (void)window.solve(x);
  }
  EXPECT_LE(window.size(), 30U);
  EXPECT_GE(window.size(), 29U);
  EXPECT_LT((window.velocity() - drive.states.back().velocity).norm(), 5e-3);
}

TEST(InertialWindow, AWrongVelocityAtTheEndIsCorrected) {
  Drive drive;
  InertialWindow window{InertialConfig()};
  InertialState x = drive.truth;
  for (Interval& each : drive.intervals) {
    each.velocity_to = Eigen::Vector3d(1.0, 2.0, 3.0);
    window.add(each, Eigen::Vector3d::Zero());
  }
  ASSERT_TRUE(window.solve(x));
  EXPECT_LT((window.velocity() - drive.states.back().velocity).norm(), 1e-3);
}

TEST(InertialWindow, FewIntervalsChangeNothing) {
  const Drive drive;
  InertialWindow window{InertialConfig()};
  for (int i = 0; i < 4; ++i) window.add(drive.intervals[static_cast<std::size_t>(i)], {0, 0, 0});
  InertialState x;
  EXPECT_FALSE(window.solve(x));
  EXPECT_EQ(x.up, Eigen::Vector3d::UnitZ());
}

}  // namespace
}  // namespace aims::bievr
