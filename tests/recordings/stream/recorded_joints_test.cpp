// SPDX-License-Identifier: BSD-3-Clause
// Legs of a recording without leg odometry.
#include <gtest/gtest.h>

#include <algorithm>
#include <numbers>

#include "core/leg_kinematics.hpp"
#include "recordings/inspection/bag_info.hpp"
#include "recordings/legs/contact_detector.hpp"
#include "recordings/messages/message_types.hpp"
#include "tests/recordings/stream/recorded_deliveries.hpp"
#include "tests/recordings/stream/recorded_trot.hpp"
#include "tests/recordings/stream/robot_recording.hpp"

namespace aims {
namespace {

using test::kMounted;
using test::kStart;
using test::RecordedTrot;
using test::Recording;
using test::RobotRecording;
using test::TrotOptions;

/// Where nothing states the lengths of the legs.
constexpr LegGeometry kGo1 = {0.188, 0.047, 0.08, 0.213, 0.213, 0.022};

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
  const Eigen::Vector3d expected =
      (velocity_from_foot(1, right, kGo1) + velocity_from_foot(2, left, kGo1)) / 2.0;
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
  LegGeometry expected = kGo1;
  expected.thigh = 0.3;
  EXPECT_EQ(setup.rig.leg_geometry, expected);
  EXPECT_NEAR(setup.rig.imu_rate_hz, setup.imu_rate_hz.value(), 0.1 * setup.rig.imu_rate_hz);
  EXPECT_EQ(setup.rig.leg_rate_hz, SensorRig().leg_rate_hz) << "no packets: the nominal rate";
}

TEST_F(RecordedTrot, JointsWithoutNamesAreGivenByTheirIndices) {
  RecordingConfig config;
  for (const int first : {3, 0, 9, 6}) {  // the array has FR FL RR RL
    for (int part = 0; part < 3; ++part) config.joint_names.push_back(std::to_string(first + part));
  }
  const Recording right =
      read({.named = false, .legs = {1, 0, 3, 2}, .feet = {0, 1, 2, 3}}, config);
  ASSERT_EQ(right.error, "");
  EXPECT_NEAR(speed(right), test::Trot::kSpeed, 0.02);
  config.joint_names.back() = "12";
  EXPECT_TRUE(read({.named = false}, config)
                  .noted("the joints have no names: set "
                         "recording.joint_names to the twelve indices"));
}

TEST_F(RecordedTrot, JointsOfNumberedLegsWithoutRatesAreOrderedByTheMotion) {
  const Recording numbered = read({.numbered = true, .rates = false, .legs = {1, 0, 3, 2}});
  ASSERT_EQ(numbered.error, "");
  EXPECT_TRUE(numbered.noted("the names 'leg0_joint0, leg0_joint1"));
  EXPECT_TRUE(numbered.noted("tell no joints: legs in the order ")) << "which one is said";
  EXPECT_NEAR(speed(numbered), test::Trot::kSpeed, 0.02);
}

TEST_F(RecordedTrot, AnglesInDegreesAreNamedAndConverted) {
  const TrotOptions degrees = {.unit = std::numbers::pi / 180.0};
  EXPECT_TRUE(read(degrees).noted("recording.joint_unit=deg"));
  RecordingConfig config;
  config.joint_unit = JointUnit::kDegrees;
  const Recording right = read(degrees, config);
  EXPECT_FALSE(right.noted("are they in degrees?"));
  EXPECT_NEAR(speed(right), test::Trot::kSpeed, 0.02);
  EXPECT_FALSE(read({}).noted("are they in degrees?"));
}

TEST_F(RecordedTrot, RatesThatContradictTheAnglesAreNamedOnceAndByInfo) {
  const auto is_rates = [](const ReadingWarning& each) {
    return each.kind == WarningKind::kJointRates;
  };
  for (const auto& [scale, cause] :
       {std::pair(180.0 / std::numbers::pi, "the rates are in deg/s beside angles in rad"),
        {-1.0, "the rates have the opposite sign"},
        {9.1, "as those of motors before their gears"},
        {1.0, ""},
        {0.8, ""}}) {
    const std::string part = cause;
    const Recording found = read({.rate_scale = scale});
    EXPECT_EQ(std::ranges::count_if(found.setup.warnings, is_rates), part.empty() ? 0 : 1) << scale;
    EXPECT_TRUE(part.empty() || found.noted(part)) << scale;
    RecordingConfig config;
    config.topics.lidar = "none";
    config.topics.contacts = "/foot_forces";
    const auto info = bag_info(write({.rate_scale = scale}), config, {});
    ASSERT_TRUE(info);
    const auto says = std::ranges::any_of(info->notes, [](const std::string& each) {
      return each.find("what their angles change by") != std::string::npos;
    });
    EXPECT_EQ(says, !part.empty()) << scale;
  }
}

TEST_F(RecordedTrot, LengthsOfTheLegsThatNothingStatesAreAWarning) {
  const auto is_assumed = [](const ReadingWarning& each) {
    return each.reason == "lengths of the legs assumed" && each.sensor == WarnedSensor::kLegs;
  };
  EXPECT_EQ(std::ranges::count_if(read({}).setup.warnings, is_assumed), 1);
  RecordingConfig config;
  config.leg_geometry.thigh = kGo1.thigh;
  const Recording given = read({}, config);
  EXPECT_EQ(std::ranges::count_if(given.setup.warnings, is_assumed), 0);
  EXPECT_EQ(given.setup.rig.leg_geometry, kGo1) << "the other lengths are assumed";
  EXPECT_TRUE(given.noted("foot_radius 0.022 m of a Unitree Go1")) << "and it is said";
}

TEST_F(RecordedTrot, AThresholdThatIsAskedForIsKeptWhereLoadsAreSmall) {
  RecordingConfig config;
  EXPECT_TRUE(read({.load = 1.0F}, config).noted("a flag, threshold 0.5"));
  config.contact_detection = ContactDetection::kThreshold;
  const Recording none = read({.load = 1.0F}, config);
  ASSERT_EQ(none.error, "");
  EXPECT_FALSE(none.noted("a flag, threshold 0.5"));
}

TEST_F(RecordedTrot, AThresholdBesideLearnedOnesIsNamed) {
  RecordingConfig config;
  config.contact_detection = ContactDetection::kLearned;
  EXPECT_FALSE(read({}, config).noted("is not used"));
  config.contact_threshold = 50.0;
  EXPECT_TRUE(read({}, config).noted("recording.contact_threshold=50 is not used"));
  config.contact_detection = ContactDetection::kThreshold;
  EXPECT_FALSE(read({}, config).noted("is not used"));
}

TEST_F(RecordedTrot, JointsOfWhichMessagesAreMissingAreNamedByTheirTopic) {
  EXPECT_FALSE(read({}).noted("are missing"));
  EXPECT_TRUE(read({.lost = 5}).noted("/joint_states: 80 of 399 messages are missing"));
}

TEST_F(RecordedTrot, KneesOfTheWrongSignAreNamedAtTheEnd) {
  EXPECT_FALSE(read({}).noted("below its hip"));
  EXPECT_TRUE(read({.knee_sign = -1.0}).noted("below its hip"));
}

TEST_F(RecordedTrot, LoadsOfTheReversedSignAreNamedAndRead) {
  EXPECT_FALSE(read({}).noted("the reversed sign"));
  const Recording reversed = read({.load = -60.0F});
  EXPECT_TRUE(reversed.noted("/foot_forces: the loads of FL (-60 to 0), FR (-60 to 0)"));
  EXPECT_NEAR(speed(reversed), test::Trot::kSpeed, 0.02);
}

TEST_F(RecordedTrot, LoadsWithANegativeOffsetAreNamedAndNoContacts) {
  for (const auto& [load, lifted] : {std::pair(-60.0F, -120.0F), std::pair(30.0F, -30.0F)}) {
    for (const auto detection : {ContactDetection::kThreshold, ContactDetection::kLearned}) {
      RecordingConfig config;
      config.contact_detection = detection;
      const Recording offset = read({.load = load, .lifted = lifted}, config);
      EXPECT_TRUE(offset.noted("the sensor has an offset; take it off in the driver"));
      EXPECT_TRUE(test::legs_of(offset.deliveries).empty());
    }
  }
}

TEST_F(RecordedTrot, LoadsThatTurnNegativeLaterAreNoContacts) {
  ContactDetector detector({{{20.0, 20.0, 1}, {20.0, 20.0, -1}, {20.0, 20.0}, {20.0, 20.0}}});
  const FootLoads loads = {-60.0, 60.0, -60.0, 60.0};
  EXPECT_EQ(detector.detect(loads), (std::array{false, false, true, true}));
  EXPECT_TRUE(detector.contradicts_sign(loads));
  EXPECT_FALSE(detector.contradicts_sign({60.0, -60.0, -60.0, -60.0}));
}

// Loads are a hint: three feet carry the estimate.
TEST_F(RecordedTrot, AFootWhoseLoadTellsNothingIsLeftOut) {
  RecordingConfig config;
  config.contact_detection = ContactDetection::kLearned;
  const Recording one = read({.dead = {2}}, config);
  EXPECT_TRUE(one.noted("RL: all loads are equal; no contact of this foot is used"));
  const auto legs = test::legs_of(one.deliveries);
  EXPECT_TRUE(std::ranges::none_of(legs, [](const auto& each) { return each.contact[2]; }));
  EXPECT_TRUE(std::ranges::any_of(legs, [](const auto& each) { return each.contact[0]; }));
  EXPECT_NEAR(speed(one), speed(read({}, config)), 0.05);
  const Recording two = read({.dead = {1, 2}}, config);
  EXPECT_NE((two.error + two.setup.leg_lack).find("contact_threshold"), std::string::npos);
  EXPECT_TRUE(two.setup.contacts_unknown);
  EXPECT_FALSE(one.setup.contacts_unknown);
}

TEST_F(RecordedTrot, LegsInMessagesOfTheirOwnAreNamed) {
  const Recording one = read({.legs = {0, 0, 0, 0}});
  EXPECT_TRUE(one.noted("each message holds the joints of one leg")) << one.error;
}

TEST_F(RecordedTrot, TorquesOfTheKneesBelowTheThresholdAreLearned) {
  RecordingConfig config;
  config.topics.contacts = "/joint_states";
  const Recording right = read({.forces = false}, config);
  ASSERT_EQ(right.error, "");
  EXPECT_TRUE(right.noted("learned from 400 messages"));
  EXPECT_NEAR(speed(right), test::Trot::kSpeed, 0.02);
}

TEST_F(RecordedTrot, WithoutContactsTheirTopicIsAskedFor) {
  const Recording none = read({.forces = false});
  EXPECT_NE(none.setup.leg_lack.find("--topics contacts=/..."), std::string::npos)
      << none.setup.leg_lack;
  EXPECT_FALSE(none.setup.contacts_unknown) << "no steps tell what has no topic";
  EXPECT_NE(none.setup.leg_lack.find("torques of the knees (--topics contacts=/joint_states)"),
            std::string::npos)
      << none.setup.leg_lack;
}

TEST_F(RecordedTrot, FeetInAWrongOrderDisagree) {
  RecordingConfig config;
  config.foot_names = {"FL", "FR", "RL", "RR"};
  const auto apart = [](const Recording& read) {
    const auto found = read.counts.find("feet_in_contact_disagree");
    return found == read.counts.end() ? 0 : found->second;
  };
  EXPECT_LT(apart(read({}, config)), 20);
  EXPECT_GT(apart(read({.feet = {1, 0, 2, 3}}, config)), 200) << "of 400";
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
