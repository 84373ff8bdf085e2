// SPDX-License-Identifier: BSD-3-Clause
#include "bench/scoring/segment_list.hpp"

#include <gtest/gtest.h>

namespace aims {
namespace {

const Trajectory kTruth = {{0, Pose()},
                           {300 * kSecond, {Eigen::Quaterniond(1, 0, 0, 0), {9, 0, 0}}}};

std::string message_of(std::string_view text) {
  const auto list = parse_segments(text);
  return list ? "" : list.error().message;
}

TEST(SegmentList, TimesAreSecondsAndNamesAreWaysBetweenPoints) {
  const auto list = parse_segments("a-b=12.5:110.2,b-a=115:2e2,a-d");
  ASSERT_TRUE(list) << list.error().message;
  ASSERT_EQ(list->timed.size(), 2U);
  EXPECT_EQ(list->timed[0].name, "a-b");
  EXPECT_EQ(list->timed[0].begin, 12'500'000'000);
  EXPECT_EQ(list->timed[0].end, 110'200'000'000);
  EXPECT_EQ(list->timed[1].end, 200 * kSecond);
  EXPECT_EQ(list->named, std::vector<std::string>{"a-d"});
}

TEST(SegmentList, ErrorsNameTheEntry) {
  for (const char* wrong : {"ab", "a-b=1", "a-b=x:2", "a-b=2:1", "a-b=1:1", "=1:2"}) {
    EXPECT_NE(message_of(wrong).find(std::string("--segments: '") + wrong), std::string::npos)
        << message_of(wrong);
  }
  EXPECT_NE(message_of("a-b=1:2,a-b=3:4").find("'a-b': expected a name of its own"),
            std::string::npos);
  EXPECT_NE(message_of("all=1:2").find("'all'"), std::string::npos) << "that is their sum";
}

TEST(SegmentList, ResolvesInOrderOfTime) {
  const std::vector<WaypointTime> waypoint_times = {
      {"a", kSecond}, {"b", 5 * kSecond}, {"d", 9 * kSecond}, {"a", 20 * kSecond}};
  const auto list = parse_segments("late=15:16,a-d,b-a");
  ASSERT_TRUE(list);
  const auto segments = resolve_segments(*list, waypoint_times, kTruth);
  ASSERT_TRUE(segments) << segments.error().message;
  ASSERT_EQ(segments->size(), 3U);
  EXPECT_EQ((*segments)[0].name, "a-d");
  EXPECT_EQ((*segments)[0].end, 9 * kSecond);
  EXPECT_EQ((*segments)[1].name, "b-a");
  EXPECT_EQ((*segments)[2].name, "late");
}

TEST(SegmentList, WhatIsNotThereIsAnError) {
  const std::vector<WaypointTime> waypoint_times = {{"a", kSecond}, {"b", 5 * kSecond}};
  const auto unknown = resolve_segments({{}, {"b-a"}}, waypoint_times, kTruth);
  ASSERT_FALSE(unknown);
  EXPECT_EQ(unknown.error().message,
            "--segments: 'b-a': no way between two such waypoint_times; passed are: a, b");
  const auto beyond =
      resolve_segments({{{"x", kSecond, 301 * kSecond}}, {}}, waypoint_times, kTruth);
  ASSERT_FALSE(beyond);
  EXPECT_NE(beyond.error().message.find("not within the truth's stamps"), std::string::npos);
}

}  // namespace
}  // namespace aims
