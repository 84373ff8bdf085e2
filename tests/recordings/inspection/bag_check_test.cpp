// SPDX-License-Identifier: BSD-3-Clause
#include "recordings/inspection/bag_check.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "recordings/inspection/bag_warnings.hpp"

namespace aims {
namespace {

TopicInfo topic(const std::string& name, const std::string& type, double hz) {
  TopicInfo info;
  info.topic = name;
  info.type = type;
  info.messages = static_cast<std::uint64_t>(60.0 * hz);
  info.stamped = true;
  info.rate_hz = hz;
  info.largest_gap_s = 1.0 / hz;
  info.loss = 0.0;
  info.median_offset_s = info.smallest_offset_s = info.largest_offset_s = 0.0;
  info.last_stamp = 60 * kSecond;
  return info;
}

/// A bag that every system takes.
BagInfo good_bag() {
  BagInfo bag;
  bag.summary.end = 60 * kSecond;
  bag.topics = {
      topic("/imu", "sensor_msgs/Imu", 200.0), topic("/joints", "sensor_msgs/JointState", 200.0),
      topic("/odom", "nav_msgs/Odometry", 200.0), topic("/points", "sensor_msgs/PointCloud2", 10.0),
      topic("/high_state", "unitree_legged_msgs/HighState", 200.0)};
  CloudInfo cloud;
  cloud.topic = "/points";
  cloud.fields = {{"x", "float32", 0},          {"y", "float32", 4},    {"z", "float32", 8},
                  {"intensity", "float32", 12}, {"ring", "uint16", 16}, {"time", "float32", 18}};
  cloud.height = 1;
  cloud.dense = true;
  cloud.clouds = 20;
  cloud.mean_points = 28000.0;
  bag.clouds = {cloud};
  ImuInfo imu;
  imu.topic = "/imu";
  imu.oriented = true;
  imu.static_interval = StaticInterval{.begin_s = 0.0, .length_s = 5.0, .force = {0.0, 0.0, 9.81}};
  bag.imus = {imu};
  bag.transforms = {{"imu", "lidar", {}, true}};
  bag.used = {"/points", "/imu", "/odom", "/joints", "/contacts", ""};
  return bag;
}

Fulfilment worst(const BagInfo& bag, const std::string& system) {
  Fulfilment worst = Fulfilment::kMet;
  for (const RequirementCheck& each : check_bag(bag)) {
    if (each.system != system) continue;
    worst = std::max(worst, each.fulfilment);
    EXPECT_EQ(each.remedy.empty(), each.fulfilment == Fulfilment::kMet) << each.requirement;
  }
  return worst;
}

const std::vector<std::string> kSystems = {"aims_d",    "aims", "lio",  "FAST-LIO2", "LIO-SAM",
                                           "LeGO-LOAM", "LINS", "LOAM", "Leg-KILO"};

void remove_field(BagInfo& bag, const std::string& name) {
  std::erase_if(bag.clouds[0].fields, [&name](const auto& each) { return each.name == name; });
}

TEST(BagCheck, ACompleteBagMeetsAllRequirements) {
  for (const std::string& system : kSystems) {
    EXPECT_EQ(worst(good_bag(), system), Fulfilment::kMet) << system;
  }
  EXPECT_TRUE(bag_warnings(good_bag()).empty()) << bag_warnings(good_bag()).front();
}

TEST(BagCheck, WithoutRingsLioSamDoesNotRun) {
  BagInfo bag = good_bag();
  remove_field(bag, "ring");
  EXPECT_EQ(worst(bag, "LIO-SAM"), Fulfilment::kMissing);
  EXPECT_EQ(worst(bag, "FAST-LIO2"), Fulfilment::kPoor);
  EXPECT_EQ(worst(bag, "LOAM"), Fulfilment::kPoor);
}

TEST(BagCheck, LioSamRequiresTheRingAsUint16) {
  BagInfo bag = good_bag();
  bag.clouds[0].fields[4].type = "uint8";
  EXPECT_EQ(worst(bag, "LIO-SAM"), Fulfilment::kMissing);
  EXPECT_EQ(worst(bag, "FAST-LIO2"), Fulfilment::kMet);
}

TEST(BagCheck, WithoutPointTimesLegKiloDoesNotRun) {
  BagInfo bag = good_bag();
  remove_field(bag, "time");
  EXPECT_EQ(worst(bag, "Leg-KILO"), Fulfilment::kMissing);
  EXPECT_EQ(worst(bag, "LIO-SAM"), Fulfilment::kPoor);
  EXPECT_EQ(worst(bag, "aims"), Fulfilment::kPoor);
  EXPECT_EQ(worst(bag, "LOAM"), Fulfilment::kMet);
}

TEST(BagCheck, OnlyLioSamRequiresAnOrientation) {
  BagInfo bag = good_bag();
  bag.imus[0].oriented = false;
  EXPECT_EQ(worst(bag, "LIO-SAM"), Fulfilment::kMissing);
  EXPECT_EQ(worst(bag, "FAST-LIO2"), Fulfilment::kMet);
  EXPECT_EQ(worst(bag, "aims"), Fulfilment::kMet);
}

TEST(BagCheck, AnImuInGIsMissingForSystemsWithoutConversion) {
  BagInfo bag = good_bag();
  bag.imus[0].in_g = true;
  EXPECT_EQ(worst(bag, "FAST-LIO2"), Fulfilment::kMissing);
  EXPECT_EQ(worst(bag, "aims"), Fulfilment::kMet);
  EXPECT_EQ(worst(bag, "LeGO-LOAM"), Fulfilment::kMet) << "needs none";
}

TEST(BagCheck, AtFiftyHertzTheImuIsPoor) {
  BagInfo bag = good_bag();
  bag.topics[0].rate_hz = 50.0;
  EXPECT_EQ(worst(bag, "LIO-SAM"), Fulfilment::kPoor);
  EXPECT_EQ(worst(bag, "aims"), Fulfilment::kMet);
}

TEST(BagCheck, AnImuThatSendsEachSampleAgainIsAsFastAsItsNewOnes) {
  BagInfo bag = good_bag();
  bag.imus[0].new_rate_hz = 50.0;
  EXPECT_EQ(worst(bag, "LIO-SAM"), Fulfilment::kPoor);
  EXPECT_EQ(bag_warnings(bag).size(), 1U) << "sent several times";
}

TEST(BagCheck, LioSamRequiresDenseClouds) {
  BagInfo bag = good_bag();
  bag.clouds[0].not_finite_fraction = 0.2;
  EXPECT_EQ(worst(bag, "LIO-SAM"), Fulfilment::kMissing);
  EXPECT_EQ(bag_warnings(bag).size(), 1U) << "contradicts is_dense";
}

TEST(BagCheck, WithoutLegsOnlyLidarInertialSystemsRun) {
  BagInfo bag = good_bag();
  bag.used.leg_odometry = bag.used.joint_states = bag.used.contacts = "";
  std::erase_if(bag.topics,
                [](const auto& each) { return each.topic != "/imu" && each.topic != "/points"; });
  EXPECT_EQ(worst(bag, "aims"), Fulfilment::kMissing);
  EXPECT_EQ(worst(bag, "Leg-KILO"), Fulfilment::kMissing);
  EXPECT_EQ(worst(bag, "lio"), Fulfilment::kMet);
}

TEST(BagCheck, WithoutCloudsNothingRuns) {
  BagInfo bag = good_bag();
  bag.clouds.clear();
  bag.refusal = "no LiDAR";
  for (const std::string& system : kSystems) {
    EXPECT_EQ(worst(bag, system), Fulfilment::kMissing) << system;
  }
}

/// What is said of that requirement.
RequirementCheck check_of(const BagInfo& bag, const std::string& system,
                          const std::string& requirement) {
  for (const RequirementCheck& each : check_bag(bag)) {
    if (each.system == system && each.requirement == requirement) return each;
  }
  return {};
}

TEST(BagCheck, LegsThatEstimatesDoNotReadAreMissing) {
  BagInfo bag = good_bag();
  EXPECT_EQ(worst(bag, "aims_d"), Fulfilment::kMet);
  bag.leg_lack = "no threshold of contact can be learned";
  EXPECT_EQ(worst(bag, "aims_d"), Fulfilment::kMissing);
  EXPECT_EQ(check_of(bag, "aims_d", "leg odometry").found, bag.leg_lack);
}

TEST(BagCheck, WithoutCloudsThoseWithLegsSayHowTheyRun) {
  BagInfo bag = good_bag();
  bag.clouds.clear();
  bag.used.lidar = "";
  bag.transforms.clear();
  bag.refusal = "no LiDAR";
  bag.opens_without_lidar = true;
  for (const char* system : {"aims_d", "aims"}) {
    EXPECT_EQ(worst(bag, system), Fulfilment::kPoor) << system;
    EXPECT_NE(
        check_of(bag, system, "3-D LiDAR clouds").remedy.find("--set recording.topics.lidar=none"),
        std::string::npos);
  }
  EXPECT_EQ(worst(bag, "lio"), Fulfilment::kMissing);
  EXPECT_EQ(worst(bag, "Leg-KILO"), Fulfilment::kMissing);
  bag.refusal.reset();  // as with that setting
  bag.opens_without_lidar = false;
  EXPECT_EQ(worst(bag, "aims_d"), Fulfilment::kMet);
  EXPECT_EQ(check_of(bag, "aims_d", "3-D LiDAR clouds").found, "not used (topics.lidar: none)");
  EXPECT_EQ(worst(bag, "lio"), Fulfilment::kMissing);
  bag.used.leg_odometry = bag.used.joint_states = "";
  EXPECT_EQ(worst(bag, "aims_d"), Fulfilment::kMissing) << "without legs";
}

TEST(BagCheck, AnUnreadableCloudTopicCountsAsMissing) {
  BagInfo bag = good_bag();
  bag.clouds[0].clouds = 0;
  bag.clouds[0].broken = 20;
  EXPECT_EQ(worst(bag, "LOAM"), Fulfilment::kMissing);
}

TEST(BagCheck, LegKiloReadsNothingButUnitreesMessage) {
  BagInfo bag = good_bag();
  bag.topics.pop_back();
  EXPECT_EQ(worst(bag, "Leg-KILO"), Fulfilment::kMissing);
  EXPECT_EQ(worst(bag, "aims"), Fulfilment::kMet);
}

TEST(BagCheck, ConfiguredExtrinsicsReplaceThoseOfTf) {
  BagInfo bag = good_bag();
  bag.transforms.clear();
  EXPECT_EQ(worst(bag, "aims"), Fulfilment::kPoor);
  bag.extrinsics_configured = true;
  EXPECT_EQ(worst(bag, "aims"), Fulfilment::kMet);
  EXPECT_TRUE(bag_warnings(bag).empty()) << bag_warnings(bag).front();
}

TEST(BagCheck, ARefusalIsSaidInItsOwnWords) {
  BagInfo bag = good_bag();
  bag.refusal =
      "b.bag: several topics are sensor_msgs/Imu: /a, /b; choose one with recording.topics.imu";
  const std::string text = check_text(check_bag(bag));
  EXPECT_NE(text.find("aims: MISSING: readable by aims: " + *bag.refusal + "\n"), std::string::npos)
      << text;
}

TEST(BagCheck, TheTableListsWhichSystemsRun) {
  BagInfo bag = good_bag();
  remove_field(bag, "ring");
  const TextTable table = check_table(check_bag(bag));
  ASSERT_EQ(table.rows.size(), kSystems.size());
  EXPECT_EQ(table.rows[0], (std::vector<std::string>{"aims_d", "yes", "8", "0", "0"}));
  EXPECT_EQ(table.rows[4][0], "LIO-SAM");
  EXPECT_EQ(table.rows[4][1], "no");
  EXPECT_EQ(table.rows[7][0], "LOAM");
  EXPECT_EQ(table.rows[7][1], "poorly");
}

TEST(BagWarnings, EachNamesItsRemedy) {
  struct Case {
    std::string remedy;
    void (*harm)(BagInfo&);
  };
  const std::vector<Case> cases = {
      {"larger buffer", [](BagInfo& bag) { bag.topics[2].loss = 0.05; }},
      {"bridge", [](BagInfo& bag) { bag.topics[0].largest_gap_s = 2.0; }},
      {"driver's clock", [](BagInfo& bag) { bag.topics[3].backwards = 3; }},
      {"recording.leg_delay=0.0300",
       [](BagInfo& bag) {
         bag.topics[2].clock = ClockOffset{0.03, 0.9};
       }},
      {"stand before it walks", [](BagInfo& bag) { bag.imus[0].static_interval.reset(); }},
      {"calibrate", [](BagInfo& bag) { bag.imus[0].static_interval->force.z() = 9.2; }},
      {"recording.T_imu_lidar", [](BagInfo& bag) { bag.transforms.clear(); }},
      {"rosbag reindex", [](BagInfo& bag) { bag.file = "walk.bag", bag.summary.closed = false; }},
      {"enable it", [](BagInfo& bag) { remove_field(bag, "time"); }},
      {"the recording was paused, or all clocks were set forward",
       [](BagInfo& bag) {
         for (TopicInfo& topic : bag.topics) {
           topic.largest_gap_s = 3600.1;
           topic.loss = 0.9;
         }
       }},
  };
  for (const Case& each : cases) {
    BagInfo bag = good_bag();
    each.harm(bag);
    const std::vector<std::string> warnings = bag_warnings(bag);
    ASSERT_EQ(warnings.size(), 1U) << each.remedy;
    EXPECT_NE(warnings.front().find(each.remedy), std::string::npos) << warnings.front();
  }
}

}  // namespace
}  // namespace aims
