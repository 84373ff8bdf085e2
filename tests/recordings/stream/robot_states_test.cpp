// SPDX-License-Identifier: BSD-3-Clause
// Walks in closed form, recorded as the messages of robots; the oracle is the walk.
#include "recordings/messages/robot_states.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include "core/leg_kinematics.hpp"
#include "recordings/messages/message_types.hpp"
#include "tests/recordings/legs/trot.hpp"
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
using test::Trot;

constexpr Duration kStep = 20 * kMillisecond;
constexpr int kSamples = 300;

RobotSample sample_of(const Trot& trot, int k) {
  const double time = to_seconds(k * kStep) + 0.003;
  RobotSample sample;
  sample.number = k;
  sample.stamp = kStart + k * kStep;
  sample.turn_rate = trot.rate;
  sample.angles = trot.angles(time);
  sample.rates = trot.rates(time);
  sample.contact = trot.contact(time);
  for (int leg = 0; leg < kLegCount; ++leg) {
    const auto i = static_cast<std::size_t>(leg);
    const Eigen::Vector3d q = joints_of(sample.angles, leg);
    sample.feet[i] = foot_in_base(leg, q, trot.geometry);
    sample.foot_speeds[i] = foot_jacobian(leg, q, trot.geometry) * joints_of(sample.rates, leg);
  }
  return sample;
}

RecordingConfig without_lidar() {
  RecordingConfig config;
  config.topics.lidar = "none";
  return config;
}

class RobotStates : public test::RecordingTest {
 protected:
  /// Each sample is sent so many times, 2 ms apart.
  Recording walk(const RobotMessage& message, const Trot& trot, int sent = 1, bool with_imu = false,
                 RecordingConfig config = without_lidar()) {
    const auto file = folder_.path() / (std::to_string(walks_++) + ".bag");
    RobotRecording robot(file);
    robot.add_transforms(kMounted);
    for (int k = 0; k < kSamples; ++k) {
      RobotSample sample = sample_of(trot, k);
      if (with_imu) robot.add_imu(sample.stamp, 1);
      for (int i = 0; i < sent; ++i, sample.stamp += 2 * kMillisecond) {
        robot.add("/state", message.type, sample.stamp + kMillisecond, message.encode(sample));
      }
    }
    robot.close();
    return test::read_recording(file, config);
  }

  int walks_ = 0;
};

/// The velocity of the base, as the feet that stand move under it.
Eigen::Vector3d velocity_of(const Trot& trot, double time) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (const int leg : trot.contact(time)[0] ? std::array{0, 3} : std::array{1, 2}) {
    constexpr double kTiny = 1e-4;
    const Eigen::Vector3d speed =
        (trot.foot(leg, time + kTiny) - trot.foot(leg, time - kTiny)) / (2.0 * kTiny);
    sum -= speed + Eigen::Vector3d(0.0, 0.0, trot.rate).cross(trot.foot(leg, time));
  }
  return sum / 2.0;
}

/// Velocity and contacts of the samples are those of the walk.
void expect_walk(const Recording& read, const Trot& trot, Duration tolerance = kMillisecond) {
  ASSERT_EQ(read.error, "");
  const auto legs = test::legs_of(read.deliveries);
  EXPECT_GE(legs.size(), std::size_t{kSamples} - 20);
  for (const LegOdometrySample& leg : legs) {
    const Time since = leg.stamp - kStart + kStep / 2;
    const double time = to_seconds(since / kStep * kStep) + 0.003;
    EXPECT_LT(std::abs(since % kStep - kStep / 2), tolerance + 1) << leg.stamp;
    EXPECT_EQ(leg.contact, trot.contact(time)) << time;
    EXPECT_LT((leg.linear_velocity - velocity_of(trot, time)).norm(), 1e-5) << time;
    EXPECT_NEAR(leg.linear_velocity.x(), Trot::kSpeed, 0.02);
  }
}

void expect_joints(const Recording& read, const Trot& trot) {
  for (const LegOdometrySample& leg : test::legs_of(read.deliveries)) {
    const Time since = leg.stamp - kStart + kStep / 2;
    const JointVector angles = trot.angles(to_seconds(since / kStep * kStep) + 0.003);
    const JointVector read_angles = JointVector::Map(leg.joint_position.data());
    EXPECT_LT((read_angles - angles).cwiseAbs().maxCoeff(), 1e-6);
  }
}

Trot anymal() {
  return {.geometry = {0.3598, 0.104, 0.19716, 0.285, 0.349226, 0.03},
          .height = 0.5,
          .hind_knees_forward = true};
}

TEST_F(RobotStates, UnitreeStatesWithJointsAreTheWalk) {
  for (const RobotMessage& message :
       {test::go1_high_state(), test::leg_kilo_high_state(), test::fusion_portable_high_state(),
        test::go1_low_state(), test::a1_low_state()}) {
    SCOPED_TRACE(message.name);
    const Trot trot = {.rate = 0.3};
    const Recording read = walk(message, trot);
    expect_walk(read, trot, 2 * kMillisecond);
    expect_joints(read, trot);
    EXPECT_TRUE(read.noted("learned from"));
    const auto imu = test::imu_of(read.deliveries);
    ASSERT_EQ(imu.size(), std::size_t{kSamples});
    EXPECT_NEAR(imu[5].angular_velocity.z(), trot.rate, 1e-6);
  }
}

TEST_F(RobotStates, WithoutSensorsInTheFeetTheTorquesOfTheKneesServe) {
  const Trot trot = {.rate = 0.3};
  RobotMessage message = test::go1_low_state();
  message.encode = [encode = message.encode](RobotSample sample) {
    sample.has_foot_sensors = false;
    return encode(sample);
  };
  EXPECT_TRUE(walk(message, trot)
                  .noted("the loads are always 0, as without sensors in the feet; take the torques "
                         "of the knees: set recording.contacts_field=motorState[].tauEst"));
  RecordingConfig config = without_lidar();
  config.contacts_field = "motorState[].tauEst";
  const Recording read = walk(message, trot, 1, false, config);
  expect_walk(read, trot, 2 * kMillisecond);
  EXPECT_TRUE(read.noted("contacts begin/end at 'motorState[].tauEst'"));
}

TEST_F(RobotStates, AQuaternionThatBeginsWithXIsNoted) {
  const auto noted = [&](const std::array<float, 4>& quaternion) {
    RobotMessage message = test::go1_low_state();
    message.encode = [encode = message.encode, quaternion](RobotSample sample) {
      sample.quaternion = quaternion;
      return encode(sample);
    };
    return walk(message, {}).noted("as where the quaternion begins with x in place of w");
  };
  const float c = std::cos(0.3F), s = std::sin(0.3F);  // yaw of 0.6 rad
  EXPECT_TRUE(noted({0.0F, 0.0F, s, c}));
  EXPECT_FALSE(noted({c, 0.0F, 0.0F, s}));
}

TEST_F(RobotStates, FeetOfAUnitreeStateWithoutJointsAreTheWalk) {
  const Trot trot = {.rate = 0.3};
  const Recording read = walk(test::feet_high_state(), trot);
  expect_walk(read, trot, 2 * kMillisecond);
  EXPECT_TRUE(read.noted("leg odometry: from feet, contacts and gyro"));
  EXPECT_TRUE(read.noted("unitree_legged_msgs/HighState has no stamp: record times are used"));
}

TEST_F(RobotStates, SamplesSentAgainUnderNewStampsCountOnce) {
  const Trot trot = {.rate = 0.3};
  const Recording once = walk(test::leg_kilo_high_state(), trot);
  const Recording tenfold = walk(test::leg_kilo_high_state(), trot, 10);
  expect_walk(tenfold, trot);
  EXPECT_TRUE(tenfold.noted("/state: each sample is sent 10.0 times, and new every 20.0 ms"));
  EXPECT_EQ(tenfold.counts.at("repeated_samples"), 9 * kSamples);
  EXPECT_EQ(test::imu_of(tenfold.deliveries).size(), test::imu_of(once.deliveries).size());
  EXPECT_EQ(test::legs_of(tenfold.deliveries).size(), test::legs_of(once.deliveries).size());
  EXPECT_FALSE(once.noted("is sent"));
}

TEST_F(RobotStates, AnAnymalStateIsTheWalkWithTheAnymalsGeometry) {
  for (const char* package : {"any_msgs", "anymal_msgs"}) {
    const auto message = test::anymal_state(test::anymal_joints(), test::anymal_feet(), package);
    SCOPED_TRACE(message.name);
    const Recording read = walk(message, anymal(), 1, true);
    expect_walk(read, anymal());
    expect_joints(read, anymal());
    EXPECT_TRUE(read.noted("leg geometry: that of an ANYmal C"));
  }
}

TEST_F(RobotStates, JointsOfAnAnymalInAnyOrderAreFoundByTheirNames) {
  auto names = test::anymal_joints();
  auto feet = test::anymal_feet();
  // The message lists the right legs under their own names first.
  for (std::size_t leg = 0; leg < 4; leg += 2) {
    std::swap_ranges(names.begin() + 3 * leg, names.begin() + 3 * leg + 3,
                     names.begin() + 3 * leg + 3);
    std::swap(feet[leg], feet[leg + 1]);
  }
  const auto message = test::anymal_state(names, feet);
  const Recording read = walk(message, anymal(), 1, true);
  ASSERT_EQ(read.error, "");
  const auto legs = test::legs_of(read.deliveries);
  ASSERT_GT(legs.size(), 100U);
  const JointVector q = anymal().angles(0.003 + to_seconds(legs[50].stamp - kStart));
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_NEAR(legs[50].joint_position[3 + i], q[static_cast<int>(i)], 1e-6);
  }
}

TEST_F(RobotStates, UnknownNamesOfJointsAreACauseThatIsNamed) {
  std::vector<std::string> names;
  for (int i = 0; i < kJointCount; ++i) names.push_back("drive_" + std::to_string(i));
  const Recording read = walk(test::anymal_state(names, test::anymal_feet()), anymal(), 1, true);
  ASSERT_EQ(read.error, "");
  EXPECT_FALSE(read.setup.has_legs);
  EXPECT_TRUE(read.setup.leg_lack.starts_with(
      "/state: the names do not identify the twelve joints (joint_names): drive_0, drive_1"))
      << read.setup.leg_lack;
}

TEST_F(RobotStates, UnknownNamesOfFeetAreWarnedOf) {
  const Recording read =
      walk(test::anymal_state(test::anymal_joints(), {"a", "b", "c", "d"}), anymal(), 1, true);
  ASSERT_EQ(read.error, "");
  EXPECT_TRUE(read.noted("/state: no names tell the feet"));
}

TEST_F(RobotStates, ActuatorsOfAnAnymalAreTheWalkWithContactsFromTheKneesTorques) {
  const Recording read = walk(test::actuator_readings(), anymal(), 1, true);
  expect_walk(read, anymal());
  expect_joints(read, anymal());
  EXPECT_TRUE(read.noted("learned from"));
}

TEST_F(RobotStates, FeetOfASpotAreDifferencedWithinTheirContacts) {
  const Trot trot;
  const Recording read = walk(test::spot_feet(), trot, 1, true);
  ASSERT_EQ(read.error, "");
  const auto legs = test::legs_of(read.deliveries);
  ASSERT_GT(legs.size(), std::size_t{kSamples} - 20);
  for (const LegOdometrySample& leg : legs) {
    EXPECT_LT((leg.linear_velocity - Eigen::Vector3d(Trot::kSpeed, 0.0, 0.0)).norm(), 1e-9);
  }
  EXPECT_TRUE(read.noted("spot_msgs/FootStateArray has no stamp: record times are used"));
  EXPECT_FALSE(read.noted("lengths of the legs")) << "they do not matter";
  EXPECT_FALSE(read.noted("feet lie"));
}

TEST_F(RobotStates, AStateWithoutTheKnownFieldsIsNoState) {
  RobotMessage message = test::go1_low_state();
  message.type.definition = "uint32 tick\n";
  RobotRecording robot(bag());
  robot.add_imu(kStart, 20);
  MessageBytes tick;
  tick.put(std::uint32_t{7});
  robot.add("/low_state", message.type, kStart, tick);
  robot.close();
  RecordingConfig config = without_lidar();
  const Recording read = test::read_recording(bag(), config);
  ASSERT_EQ(read.error, "");
  EXPECT_TRUE(read.setup.topics.joint_states.empty());
  config.topics.joint_states = "/low_state";
  const std::string error = test::read_recording(bag(), config).error;
  EXPECT_NE(
      error.find(
          "topic '/low_state' (recording.topics.joint_states) is unitree_legged_msgs/LowState, "
          "expected sensor_msgs/JointState or a robot's state with joints"),
      std::string::npos)
      << error;
}

TEST_F(RobotStates, TooFewMotorsAreACauseThatIsNamed) {
  RobotMessage message = test::go1_low_state();
  message.type.definition = "int16[4] footForce\nIMU imu\nMotorState[] motorState\n" +
                            message.type.definition.substr(message.type.definition.find("\n==="));
  RobotRecording robot(bag());
  robot.add_imu(kStart, 50);
  MessageBytes empty;
  for (int i = 0; i < 4; ++i) empty.put(std::int16_t{9});
  for (int i = 0; i < 13; ++i) empty.put(1.0F);
  empty.put(std::int8_t{20});
  empty.length(0);
  for (int k = 0; k < 10; ++k) robot.add("/low_state", message.type, kStart + k * kStep, empty);
  robot.close();
  RecordingConfig config = without_lidar();
  config.contact_detection = ContactDetection::kThreshold;
  const Recording read = test::read_recording(bag(), config);
  ASSERT_EQ(read.error, "");
  EXPECT_EQ(read.setup.leg_lack, "/low_state: expected twelve joints or more in 'motorState[].q'");
}

TEST(RobotStateTable, EachRowHasWhatLegOdometryNeeds) {
  for (const StateLayout& state : robot_states()) {
    SCOPED_TRACE(state.type);
    EXPECT_TRUE(state.has_joints() || state.has_feet());
    EXPECT_EQ(state.contacts.empty(), state.type == kFootPlaces) << "on a topic of their own";
    EXPECT_EQ(std::set<int>(state.legs.begin(), state.legs.end()).size(), std::size_t{kLegCount});
    EXPECT_EQ(state.geometry == nullptr && state.biped == nullptr, state.robot.empty());
  }
}

}  // namespace
}  // namespace aims
