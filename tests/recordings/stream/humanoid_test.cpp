// SPDX-License-Identifier: BSD-3-Clause
// A biped that steps, recorded as unitree_hg/LowState.
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <map>

#include "tests/recordings/stream/recorded_deliveries.hpp"
#include "tests/recordings/stream/robot_messages.hpp"
#include "tests/recordings/stream/robot_recording.hpp"

namespace aims {
namespace {

using test::kMounted;
using test::kStart;
using test::Recording;
using test::RobotMessage;
using test::RobotRecording;
using test::RobotSample;

constexpr Duration kStep = 20 * kMillisecond;
constexpr int kSamples = 300;

class Humanoid : public test::RecordingTest {};

/// The sole of a G1 in its pelvis, by the rotations of its published description.
Eigen::Vector3d sole_of_g1(double side, const Eigen::Matrix<double, 6, 1>& q) {
  const auto turn = [](double angle, const Eigen::Vector3d& axis) {
    return Eigen::AngleAxisd(angle, axis).toRotationMatrix();
  };
  const Eigen::Vector3d x(1, 0, 0), y(0, 1, 0), z(0, 0, 1);
  Eigen::Vector3d p(0.0, 0.0, -0.035);
  p = Eigen::Vector3d(0.0, 0.0, -0.017558) + turn(q[5], x) * p;
  p = Eigen::Vector3d(0.0, side * -9.4445e-05, -0.30001) + turn(q[4], y) * p;
  p = Eigen::Vector3d(-0.078273, side * 0.0021489, -0.17734) + turn(0.1749, y) * turn(q[3], y) * p;
  p = Eigen::Vector3d(0.025001, 0.0, -0.12412) + turn(q[2], z) * p;
  p = Eigen::Vector3d(0.0, side * 0.052, -0.030465) + turn(-0.1749, y) * turn(q[1], x) * p;
  return Eigen::Vector3d(0.0, side * 0.064452, -0.1027) + turn(q[0], y) * p;
}

/// Joints of the legs of a biped that steps: left 0 to 5, right 6 to 11.
JointVector biped_angles(double time) {
  JointVector q;
  for (int leg = 0; leg < 2; ++leg) {
    const double phase = 2.0 * M_PI * time + M_PI * leg;
    q.segment<6>(6 * leg) << -0.3 + 0.3 * std::cos(phase), 0.05 * std::sin(phase), 0.02,
        0.6 + 0.1 * std::sin(phase), -0.3, 0.01;
  }
  return q;
}

TEST_F(Humanoid, WalksOnTheFootWhoseKneeBears) {
  RobotRecording robot(bag());
  robot.add_transforms(kMounted);
  const RobotMessage message = test::humanoid_state();
  std::map<Time, Eigen::Vector3d> expected;
  for (int k = 0; k < kSamples; ++k) {
    const double time = to_seconds(k * kStep) + 0.003;
    RobotSample sample;
    sample.stamp = kStart + k * kStep;
    sample.angles = biped_angles(time);
    constexpr double kTiny = 1e-6;
    sample.rates = (biped_angles(time + kTiny) - biped_angles(time - kTiny)) / (2.0 * kTiny);
    const int leg = std::sin(2.0 * M_PI * time) > 0.0 ? 0 : 1;
    sample.contact = {leg == 0, leg == 1, false, false};
    robot.add("/lowstate", message.type, sample.stamp, message.encode(sample));
    const auto sole = [&](double at) -> Eigen::Vector3d {
      return sole_of_g1(leg == 0 ? 1.0 : -1.0, biped_angles(at).segment<6>(6 * leg));
    };
    expected[sample.stamp] = -(sole(time + kTiny) - sole(time - kTiny)) / (2.0 * kTiny);
  }
  robot.close();
  RecordingConfig config;
  config.topics.lidar = "none";
  const Recording read = test::read_recording(bag(), config);
  ASSERT_EQ(read.error, "");
  EXPECT_TRUE(read.noted("from the joints of a G1 with 29 joints, the torques of its knees"));
  const auto legs = test::legs_of(read.deliveries);
  ASSERT_EQ(legs.size(), std::size_t{kSamples});
  for (const LegOdometrySample& leg : legs) {
    EXPECT_LT((leg.linear_velocity - expected.at(leg.stamp)).norm(), 1e-4);
  }
}

}  // namespace
}  // namespace aims
