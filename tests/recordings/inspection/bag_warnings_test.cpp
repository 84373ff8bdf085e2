// SPDX-License-Identifier: BSD-3-Clause
#include "recordings/inspection/bag_warnings.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <string>

namespace aims {
namespace {

TopicInfo topic(const std::string& name, const std::string& type, double offset_s) {
  TopicInfo info;
  info.topic = name;
  info.type = type;
  info.messages = 1000;
  info.stamped = true;
  info.median_offset_s = offset_s;
  return info;
}

/// IMU, cloud and legs, recorded that long after their stamps.
BagInfo recording(double imu_s, double lidar_s, double leg_s) {
  BagInfo info;
  info.topics = {topic("/imu", "sensor_msgs/Imu", imu_s),
                 topic("/points", "sensor_msgs/PointCloud2", lidar_s),
                 topic("/odom", "nav_msgs/Odometry", leg_s)};
  info.used.imu = "/imu";
  info.used.lidar = "/points";
  return info;
}

std::size_t advices(const BagInfo& info, const std::string& text) {
  return static_cast<std::size_t>(std::ranges::count_if(
      bag_warnings(info), [&](const auto& each) { return each.find(text) != std::string::npos; }));
}

TEST(BagWarnings, NoDelayIsAdvisedForARecorderWhoseClockAllSensorsDifferFrom) {
  EXPECT_EQ(advices(recording(1.8e9, 1.8e9 + 0.1, 1.8e9), "_delay"), 0U);
}

TEST(BagWarnings, TheAdvisedDelayIsTheDifferenceFromTheImu) {
  EXPECT_EQ(advices(recording(1.8e9, 1.8e9 + 0.1, 1.8e9 + 2.0),
                    "/odom: stamps are 2.000 s before those of /imu, by the record times; if the "
                    "clocks differ, set recording.leg_delay=-2.000"),
            1U);
  EXPECT_EQ(advices(recording(0.0, -3.0, 0.0), "recording.lidar_delay=3.000"), 1U);
}

TEST(BagWarnings, WhatReadingSaysOfAClockIsNotContradicted) {
  BagInfo info = recording(10.0, 0.1, 0.0);
  info.topics[2].clock = ClockOffset{-0.478, 0.72};  // an alias of the gait
  info.topics[0].repeated = 9;
  EXPECT_EQ(advices(info, "set recording.lidar_delay=9.900"), 1U);
  EXPECT_EQ(advices(info, "set recording.leg_delay=10.000"), 1U);
  EXPECT_EQ(advices(info, "set recording.leg_delay=-0.4780"), 1U);
  info.stamp_faults = {{"/imu", StampFault::kOtherClock}};
  EXPECT_EQ(advices(info, "_delay="), 0U);
  EXPECT_EQ(advices(info, "such messages are dropped"), 1U);
  info.stamp_faults = {{"/imu", StampFault::kUnusable}};
  EXPECT_EQ(advices(info, "such messages are dropped"), 0U);
}

TEST(BagWarnings, WithoutAnImuRecordTimesAreTheReference) {
  BagInfo info = recording(0.0, 0.0, 7.0);
  info.used = {};
  EXPECT_EQ(advices(info, "/odom: stamps are 7.000 s before the record times"), 1U);
}

TEST(BagWarnings, AnImuOfAHundredHertzThatMeasuresALittleLessIsFastEnough) {
  BagInfo info = recording(0.0, 0.1, 0.0);
  info.imus.emplace_back().topic = "/imu";
  info.topics[0].rate_hz = 99.7;
  EXPECT_EQ(advices(info, "footfalls alias"), 0U);
  info.topics[0].rate_hz = 62.0;
  EXPECT_EQ(advices(info, "/imu: 62 Hz; footfalls alias"), 1U);
}

TEST(BagWarnings, DelaysHaveNoNegativeZeros) {
  EXPECT_EQ(advices(recording(0.3, 0.3, -1e-9), "/odom 0.000 s: their clocks may differ"), 1U);
}

TEST(BagWarnings, BatchesThatShareAStampAreNamed) {
  BagInfo info = recording(0.0, 0.1, 0.0);
  info.topics[0].repeated = 900;
  EXPECT_EQ(advices(info, "/imu: 900 stamps repeat"), 1U);
  info.topics[0].messages_per_stamp = 10.0;
  info.topics[0].rate_hz = 200.0;
  info.topics[0].largest_gap_s = 0.055;
  EXPECT_EQ(advices(info,
                    "/imu: comes in batches of about 10 messages with one stamp: 200.0 Hz, but "
                    "20.0 stamps a second; record times serve in their place"),
            1U);
  EXPECT_EQ(advices(info, "stamps repeat"), 0U);
  EXPECT_EQ(advices(info, "/imu: a gap"), 0U);
}

TEST(BagWarnings, OfTooShortARecordingThatIsSaidAndNoLackOfStanding) {
  BagInfo info = recording(0.0, 0.1, 0.0);
  info.imus.emplace_back().topic = "/imu";
  info.topics[1].messages = 7;
  info.summary.end = 700 * kMillisecond;
  EXPECT_EQ(advices(info, "too short: 7 scans over 0.7 s"), 1U);
  EXPECT_EQ(advices(info, "is not static"), 0U);
  info.topics[1].messages = 100;
  info.summary.end = 10 * kSecond;
  EXPECT_EQ(advices(info, "too short"), 0U);
  EXPECT_EQ(advices(info, "is not static"), 1U);
}

}  // namespace
}  // namespace aims
