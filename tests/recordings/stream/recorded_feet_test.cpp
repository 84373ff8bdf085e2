// SPDX-License-Identifier: BSD-3-Clause
// Feet that are recorded as places in the base, without joints.
#include <gtest/gtest.h>

#include <array>
#include <string>
#include <vector>

#include "tests/recordings/stream/message_fields.hpp"
#include "tests/recordings/stream/recorded_trot.hpp"

namespace aims {
namespace {

using test::Recording;
using test::RobotRecording;

/// A trot whose feet are recorded without joints.
class RecordedFeet : public test::RecordingTest {
 protected:
  struct Feet {
    std::array<std::string, kLegCount> places = {"/fl_foot/position", "/fr_foot/position",
                                                 "/rl_foot/position", "/rr_foot/position"};
    std::array<std::string, kLegCount> contacts = {"/fl_foot/contact", "/fr_foot/contact",
                                                   "/rl_foot/contact", "/rr_foot/contact"};
    std::array<int, kLegCount> legs = {0, 1, 2, 3};  ///< of the topics, or of the entries
    std::string frame = "base";
    bool with_arm = false;
    std::string chosen = {};           ///< the topic of the legs
    std::string chosen_contacts = {};  ///< likewise
    Eigen::Vector3d shift = Eigen::Vector3d::Zero();
  };

  void add_single(RobotRecording& robot, const Feet& feet, Time now, double time) const {
    const MessageType point = {"geometry_msgs/PointStamped", "c63aecb41bfdfd6b7e1fac37c7cbe7bf",
                               "Header header\ngeometry_msgs/Point point\n" + test::used_header() +
                                   test::used_vector("geometry_msgs/Point")};
    const MessageType flag = {"std_msgs/Bool", "8b94c1b53db61fb6aed406028ad6332a", "bool data\n"};
    for (std::size_t i = 0; i < feet.legs.size(); ++i) {
      MessageBytes place, contact;
      test::put_header(place, now, feet.frame);
      test::put_vector<double>(place, trot_.foot(feet.legs[i], time) + feet.shift);
      robot.add(feet.places[i], point, now, place);
      contact.put(
          static_cast<std::uint8_t>(trot_.contact(time)[static_cast<std::size_t>(feet.legs[i])]));
      robot.add(feet.contacts[i], flag, now, contact);
    }
  }

  /// All feet and their loads in arrays of one message.
  void add_arrays(RobotRecording& robot, const Feet& feet, Time now, double time) const {
    MessageBytes out;
    test::put_header(out, now, feet.frame);
    for (const int leg : feet.legs)
      test::put_vector<float>(out, trot_.foot(leg, time) + feet.shift);
    for (const int leg : feet.legs) {
      out.put(std::int16_t{trot_.contact(time)[static_cast<std::size_t>(leg)]});
    }
    robot.add("/body_state",
              {"my_msgs/BodyState", "",
               "Header header\nfloat32[12] foot_position_body\nint16[4] foot_contact\n" +
                   test::used_header()},
              now, out);
  }

  /// An arm, whose joints are none of the legs.
  static void add_arm(RobotRecording& robot, Time now) {
    MessageBytes out;
    test::put_header(out, now, "base");
    out.length(1);
    out.text("arm_elbow");
    for (int i = 0; i < 3; ++i) out.array(std::vector<double>{0.1});
    robot.add("/joint_states", joint_state_type(), now, out);
  }

  Recording read(const Feet& feet, bool arrays = false) {
    const auto file = folder_.path() / (std::to_string(count_++) + ".bag");
    RobotRecording robot(file);
    robot.add_transforms(test::kMounted);
    for (int k = 0; k < 400; ++k) {
      const Time now = test::kStart + k * 10 * kMillisecond;
      robot.add_imu(now, 1);
      if (feet.with_arm) add_arm(robot, now);
      if (arrays) {
        add_arrays(robot, feet, now, 0.01 * k + 0.003);
      } else {
        add_single(robot, feet, now, 0.01 * k + 0.003);
      }
    }
    robot.close();
    RecordingConfig config;
    config.topics.lidar = "none";
    config.topics.leg_odometry = feet.chosen;
    config.topics.contacts = feet.chosen_contacts;
    return test::read_recording(file, config);
  }

  static void expect_walk(const Recording& recording) {
    ASSERT_EQ(recording.error, "");
    EXPECT_GT(test::legs_of(recording.deliveries).size(), 380U);
    EXPECT_NEAR(test::RecordedTrot::speed(recording), test::Trot::kSpeed, 0.02);
    EXPECT_FALSE(recording.noted("feet lie"));
    EXPECT_FALSE(recording.noted("contradict"));
    EXPECT_EQ(recording.counts.count("legs_not_finite"), 0U);
  }

  /// In the middle of a step.
  void expect_contacts(const Recording& recording) const {
    const LegOdometrySample each = test::legs_of(recording.deliveries).at(60);
    EXPECT_EQ(each.contact, trot_.contact(to_seconds(each.stamp - test::kStart) + 0.003));
  }

  test::Trot trot_;
  int count_ = 0;
};

TEST_F(RecordedFeet, OnTopicsOfTheirOwnAreJoined) {
  const Recording single = read({});
  expect_walk(single);
  EXPECT_TRUE(single.noted("/foot/position/feet: joined from /fl_foot/position"));
  EXPECT_TRUE(single.noted("/foot/contact/contacts: joined from /fl_foot/contact"));
}

TEST_F(RecordedFeet, AsNumbersAreFoundByTheirPlaces) {
  Feet feet;
  feet.legs = {3, 1, 0, 2};
  for (std::size_t i = 0; i < feet.places.size(); ++i) {
    feet.places[i] = "/foot_" + std::to_string(i) + "/position";
    feet.contacts[i] = "/foot_" + std::to_string(i) + "/contact";
  }
  const Recording numbered = read(feet);
  expect_walk(numbered);
  EXPECT_TRUE(numbered.noted("(RR FR FL RL in their order, by their places)"));
  expect_contacts(numbered);
}

TEST_F(RecordedFeet, InArraysOfAnyMessageAreFoundByTheirPlaces) {
  Feet feet;
  feet.legs = {1, 0, 3, 2};  // as Unitree lists them
  const Recording arrays = read(feet, true);
  expect_walk(arrays);
  EXPECT_TRUE(
      arrays.noted("/body_state/feet: joined from /body_state, whose messages hold all "
                   "feet (FR FL RR RL in their order, by their places)"));
  expect_contacts(arrays);
}

TEST_F(RecordedFeet, BesideJointsAreReadWhenChosen) {
  Feet feet;
  feet.with_arm = true;
  EXPECT_TRUE(read(feet).noted("to read it, --topics leg_odometry=/foot/position/feet"));
  feet.chosen = "/foot/position/feet";
  expect_walk(read(feet));
}

TEST_F(RecordedFeet, WithoutContactsOfFourFeetAreRefusedByTheTopic) {
  Feet feet;
  feet.chosen_contacts = "/imu";
  const Recording none = read(feet);
  EXPECT_FALSE(none.setup.has_legs);
  EXPECT_EQ(none.setup.leg_lack,
            "/imu holds no contacts of four feet: expected a number for each foot");
}

TEST_F(RecordedFeet, OfTheWorldAreRefused) {
  Feet feet;
  feet.frame = "odom";
  const Recording world = read(feet);
  EXPECT_FALSE(world.setup.has_legs);
  EXPECT_NE(world.setup.leg_lack.find("frame 'odom', which does not move with the robot"),
            std::string::npos)
      << world.setup.leg_lack;
}

TEST_F(RecordedFeet, ThatDoNotLieAroundTheBaseAreNamed) {
  Feet feet;
  feet.shift.x() = 0.6;
  EXPECT_TRUE(read(feet).noted("expected FL, FR, RL, RR around the base"));
}

}  // namespace
}  // namespace aims
