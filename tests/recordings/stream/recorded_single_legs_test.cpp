// SPDX-License-Identifier: BSD-3-Clause
// Legs in messages of their own, and samples that are recorded in batches.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <functional>
#include <string>

#include "recordings/legs/leg_names.hpp"
#include "tests/recordings/stream/recorded_trot.hpp"

namespace aims {
namespace {

using test::RecordedTrot;
using test::Recording;
using test::RobotRecording;

TEST_F(RecordedTrot, LegsOnTopicsOfTheirOwnAreJoined) {
  const auto whole = test::legs_of(read({}).deliveries);
  for (const bool named : {true, false}) {
    const Recording single = read({.named = named, .single = "/{}/joint_states"});
    ASSERT_EQ(single.error, "");
    EXPECT_TRUE(
        single.noted("/joint_states/joints: joined from /fl/joint_states, /fr/joint_states, "
                     "/rl/joint_states, /rr/joint_states"));
    EXPECT_EQ(single.noted("the names 'FL_0, FL_1, FL_2, FR_0"), !named) << "their order is said";
    const auto legs = test::legs_of(single.deliveries);
    ASSERT_EQ(legs.size(), whole.size());
    for (std::size_t i = 0; i < legs.size(); ++i) {
      ASSERT_EQ(legs[i].stamp, whole[i].stamp);
      ASSERT_EQ(legs[i].joint_position, whole[i].joint_position);
      ASSERT_EQ(legs[i].linear_velocity, whole[i].linear_velocity);
    }
  }
}

TEST_F(RecordedTrot, LegsInMessagesThatNameThemAreJoined) {
  const Recording one = read({.single = "/leg_states"});
  ASSERT_EQ(one.error, "");
  EXPECT_TRUE(
      one.noted("/leg_states/joints: joined from /leg_states, whose messages name their leg"));
  EXPECT_NEAR(speed(one), test::Trot::kSpeed, 0.02);
}

/// A trot whose legs are messages of a robot's own type, which name their leg.
class OwnLegs : public test::RecordingTest {
 protected:
  Recording read(const std::string& leg_type, std::function<void(MessageBytes&, int)> put_leg) {
    RobotRecording robot(bag());
    robot.add_transforms(test::kMounted);
    const MessageType type = {"my_msgs/Leg", "",
                              "Header header\n" + leg_type +
                                  " leg_id\nfloat64[3] q\nfloat64[3] dq\nbool in_contact\n" +
                                  std::string(80, '=') +
                                  "\nMSG: std_msgs/Header\nuint32 seq\ntime stamp\nstring "
                                  "frame_id\n"};
    const test::Trot trot;
    for (int k = 0; k < 400; ++k) {
      const Time now = test::kStart + k * 10 * kMillisecond;
      const double time = 0.01 * k + 0.003;
      robot.add_imu(now, 1);
      for (const int leg : {2, 0, 3, 1}) {
        MessageBytes out;
        out.put(std::uint32_t{0});
        out.time(now);
        out.text("base");
        put_leg(out, leg);
        for (int i = 0; i < 3; ++i) out.put(trot.angles(time)[3 * leg + i]);
        for (int i = 0; i < 3; ++i) out.put(trot.rates(time)[3 * leg + i]);
        out.put(static_cast<std::uint8_t>(trot.contact(time)[static_cast<std::size_t>(leg)]));
        robot.add("/legs", type, now, out);
      }
    }
    robot.close();
    RecordingConfig config;
    config.topics.lidar = "none";
    return test::read_recording(bag(), config);
  }
};

TEST_F(OwnLegs, AreJoinedByTheirNames) {
  const Recording named = read("string", [](MessageBytes& out, int leg) {
    out.text(std::array{"front_left", "front_right", "hind_left",
                        "hind_right"}[static_cast<std::size_t>(leg)]);
  });
  ASSERT_EQ(named.error, "");
  EXPECT_TRUE(named.noted("/legs/contacts: joined from /legs, whose messages name their leg"));
  EXPECT_TRUE(named.noted("their joints are taken as abduction, hip and knee"));
  EXPECT_NEAR(RecordedTrot::speed(named), test::Trot::kSpeed, 0.02);
}

TEST_F(OwnLegs, AsNumbersHaveNoPlaceByThem) {
  const Recording numbered =
      read("uint8", [](MessageBytes& out, int leg) { out.put(static_cast<std::uint8_t>(leg)); });
  EXPECT_TRUE(numbered.noted("'leg0_0, leg0_1, leg0_2, leg1_0") ||
              numbered.setup.leg_lack.find("leg0_0") != std::string::npos);
  EXPECT_FALSE(numbered.noted("their joints are taken as"));
}

TEST(NamedLeg, IsTheLegAndTheRestOfAName) {
  const auto text = [](std::string_view name) {
    const auto named = named_leg(name);
    return named ? named->id + " " + named->rest : "none";
  };
  EXPECT_EQ(text("/FL/joint_states"), "FL /joint_states");
  EXPECT_EQ(text("/visual/rr_foot_contact/the_force"), "RR /visual/foot_contact/the_force");
  EXPECT_EQ(text("/robot/left_hind/joints"), "RL /robot/joints");
  EXPECT_EQ(text("/FrontRightFootContact"), "FR /foot_contact");
  EXPECT_EQ(text("/lfFoot"), "FL /foot");
  EXPECT_EQ(text("/leg2/state"), "2 /leg/state");
  EXPECT_EQ(text("/foot_3/contact"), "3 /foot/contact");
  EXPECT_EQ(text("/camera_2/joints"), "none");
  EXPECT_EQ(text("/joint_states"), "none");
  EXPECT_FALSE(named_leg("/leg2/state")->leg) << "a number tells no place";
}

TEST_F(RecordedTrot, ALegThatDiesIsNoFootThatStands) {
  const Recording dead = read({.single = "/{}/joint_states", .dies = 100});
  ASSERT_EQ(dead.error, "");
  EXPECT_NEAR(speed(dead), test::Trot::kSpeed, 0.03);
  EXPECT_GT(dead.counts.at("joints_not_finite"), 250);
  const auto legs = test::legs_of(dead.deliveries);
  EXPECT_FALSE(std::ranges::any_of(legs.end() - 200, legs.end(), [](const auto& each) {
    return each.contact[3] ||
           !Eigen::Map<const JointVector>(each.joint_position.data()).allFinite();
  }));
}

TEST_F(RecordedTrot, LegsOfWhichOneIsMissingAreNamed) {
  const Recording three = read({.single = "/{}/joint_states", .absent = {2}});
  EXPECT_FALSE(three.setup.has_legs);
  EXPECT_TRUE(
      three.noted("/fl/joint_states, /fr/joint_states, /rr/joint_states "
                  "(sensor_msgs/JointState) hold one leg each"));
  EXPECT_NE(three.setup.leg_lack.find("they are not joined"), std::string::npos);
  EXPECT_FALSE(read({}).noted("one leg"));
}

TEST_F(RecordedTrot, JointsAndLoadsInBatchesAreSpread) {
  const auto apart = [](const Recording& each) {
    const auto found = each.counts.find("feet_in_contact_disagree");
    return found == each.counts.end() ? 0 : found->second;
  };
  for (const std::string single : {"", "/{}/joint_states"}) {
    const Recording batches = read({.single = single, .batch = 10});
    ASSERT_EQ(batches.error, "");
    EXPECT_TRUE(batches.noted("record times come in batches of 10 samples"));
    EXPECT_NEAR(speed(batches), test::Trot::kSpeed, 0.02);
    EXPECT_LT(apart(batches), 20) << "joints and loads of one instant";
    const auto legs = test::legs_of(batches.deliveries);
    ASSERT_GT(legs.size(), 350U);
    for (std::size_t i = 30; i < legs.size(); ++i) {
      ASSERT_NEAR(to_seconds(legs[i].stamp - legs[i - 1].stamp), 0.01, 0.001) << i;
    }
  }
}

}  // namespace
}  // namespace aims
