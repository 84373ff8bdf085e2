// SPDX-License-Identifier: BSD-3-Clause
// Legs of a recording without leg odometry.
#include <gtest/gtest.h>

#include "core/leg_kinematics.hpp"
#include "recordings/messages/message_types.hpp"
#include "tests/recordings/stream/recorded_deliveries.hpp"
#include "tests/recordings/stream/robot_recording.hpp"

namespace aims {
namespace {

using test::kMounted;
using test::kStart;
using test::Recording;
using test::RobotRecording;

class RecordedJoints : public test::RecordingTest {};

/// A standing robot whose joints tell its effort; the knees of FR and RL bear.
MessageBytes joints(Time stamp, const std::vector<std::string>& names) {
  MessageBytes out;
  out.put(std::uint32_t{0});
  out.time(stamp);
  out.text("base");
  out.length(names.size());
  for (const std::string& name : names) out.text(name);
  std::vector<double> position, velocity, effort;
  for (int leg = 0; leg < kLegCount; ++leg) {
    for (const double angle : {0.0, 0.8, -1.6}) position.push_back(angle);
    for (int i = 0; i < 3; ++i) velocity.push_back(0.1 * (leg + 1));
    const bool bears = leg == 1 || leg == 2;
    for (const double torque : {1.0, 2.0, bears ? -24.0 : 0.5}) effort.push_back(torque);
  }
  for (const auto* each : {&position, &velocity, &effort}) out.array(*each);
  return out;
}

TEST_F(RecordedJoints, KneeTorquesReplaceContacts) {
  RobotRecording robot(bag());
  robot.add_transforms(kMounted);
  robot.add_imu(kStart, 20);
  robot.add_clouds(kStart, 3);
  std::vector<std::string> names;
  for (const char* leg : {"FL", "FR", "RL", "RR"}) {
    for (const char* part : {"_hip_joint", "_thigh_joint", "_calf_joint"}) {
      names.push_back(std::string(leg) + part);
    }
  }
  for (int k = 0; k < 10; ++k) {
    const Time now = kStart + kSecond / 10 + k * 5 * kMillisecond;
    robot.add("/joint_states", joint_state_type(), now, joints(now, names));
  }
  robot.close();
  EXPECT_TRUE(test::read_recording(bag()).noted(
      "knee torques can indicate contacts: set topics.contacts: /joint_states"));
  RecordingConfig config;
  config.topics.contacts = "/joint_states";
  const Recording read = test::read_recording(bag(), config);
  ASSERT_EQ(read.error, "");
  const auto legs = test::legs_of(read.deliveries);
  ASSERT_EQ(legs.size(), 10U);
  EXPECT_EQ(legs[0].contact, (std::array<bool, 4>{false, true, true, false}));
  const LegMotion right{{0.0, 0.8, -1.6}, Eigen::Vector3d::Constant(0.2), Eigen::Vector3d::Zero()};
  const LegMotion left{{0.0, 0.8, -1.6}, Eigen::Vector3d::Constant(0.3), Eigen::Vector3d::Zero()};
  const Eigen::Vector3d expected = (velocity_from_foot(1, right, config.leg_geometry) +
                                    velocity_from_foot(2, left, config.leg_geometry)) /
                                   2.0;
  EXPECT_LT((legs[0].linear_velocity - expected).norm(), 1e-12);
}

TEST_F(RecordedJoints, TheRigHasTheGeometryAndTheRatesOfTheRecording) {
  RobotRecording robot(bag());
  robot.add_imu(kStart, 20);
  robot.add_clouds(kStart, 3);
  robot.close();
  RecordingConfig config;
  config.leg_geometry.thigh = 0.3;
  const auto reader = RecordingReader::open(bag(), config);
  ASSERT_TRUE(reader) << reader.error().message;
  const RecordingSetup& setup = reader->setup();
  EXPECT_EQ(setup.rig.leg_geometry, config.leg_geometry);
  EXPECT_NEAR(setup.rig.imu_rate_hz, setup.imu_rate_hz.value(), 0.1 * setup.rig.imu_rate_hz);
  EXPECT_EQ(setup.rig.leg_rate_hz, SensorRig().leg_rate_hz) << "no packets: the nominal rate";
}

TEST_F(RecordedJoints, UnknownJointNamesAreNoted) {
  RobotRecording robot(bag());
  robot.add_imu(kStart, 20);
  robot.add_clouds(kStart, 3);
  robot.add("/joint_states", joint_state_type(), kStart, joints(kStart, {"FL_hip", "arm_1"}));
  robot.close();
  const Recording read = test::read_recording(bag());
  EXPECT_TRUE(read.noted("the names do not identify the twelve joints (joint_names)"));
  EXPECT_EQ(read.counts.at("joints_malformed"), 1);
}

}  // namespace
}  // namespace aims
