// SPDX-License-Identifier: BSD-3-Clause
#include "recordings/inspection/topic_statistics.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <utility>
#include <vector>

namespace aims {
namespace {

constexpr Duration kPeriod = 5 * kMillisecond;

TopicInfo info_of(TopicStatistics& statistics) {
  TopicInfo info;
  statistics.finish(info);
  return info;
}

TEST(TopicStatistics, RateIsRobustToLosses) {
  TopicStatistics statistics;
  int lost = 0;
  for (int i = 0; i < 2000; ++i) {
    const bool drop = i % 20 == 7 || (i >= 1000 && i < 1040);
    if (drop) {
      ++lost;
      continue;
    }
    const Time stamp = i * kPeriod;
    statistics.add(stamp + kMillisecond, stamp);
  }
  const TopicInfo info = info_of(statistics);
  EXPECT_EQ(info.messages, 2000U - lost);
  EXPECT_NEAR(info.rate_hz.value(), 200.0, 0.01);
  EXPECT_NEAR(info.loss.value(), lost / 2000.0, 1e-3);
  EXPECT_NEAR(info.largest_gap_s.value(), 41 * 0.005, 1e-6);
}

TEST(TopicStatistics, CountsStampsThatRepeatOrGoBackwards) {
  TopicStatistics statistics;
  for (const int at : {0, 1, 2, 2, 3, 1, 4, 5}) statistics.add(at * kPeriod, at * kPeriod);
  const TopicInfo info = info_of(statistics);
  EXPECT_EQ(info.repeated, 1U);
  EXPECT_EQ(info.backwards, 1U);
}

TEST(TopicStatistics, BatchesThatShareAStampHaveTheRateOfTheirMessages) {
  TopicStatistics statistics;
  for (int i = 0; i < 1000; ++i) {
    const Time stamp = (i / 10) * 10 * kPeriod;
    statistics.add(stamp + kMillisecond, stamp);
  }
  const TopicInfo info = info_of(statistics);
  EXPECT_NEAR(info.rate_hz.value(), 200.0, 0.01);
  EXPECT_NEAR(info.messages_per_stamp.value(), 10.0, 1e-9);
  EXPECT_EQ(info.repeated, 900U);
}

TEST(TopicStatistics, MeasuresTheRecordingDelay) {
  TopicStatistics statistics;
  for (int i = 0; i < 101; ++i) {
    const Time stamp = i * kPeriod;
    statistics.add(stamp + (i == 50 ? 90 : 10 + i % 3) * kMillisecond, stamp);
  }
  const TopicInfo info = info_of(statistics);
  EXPECT_TRUE(info.stamped);
  EXPECT_NEAR(info.median_offset_s.value(), 0.011, 1e-6);
  EXPECT_NEAR(info.smallest_offset_s.value(), 0.010, 1e-6);
  EXPECT_NEAR(info.largest_offset_s.value(), 0.090, 1e-6);
}

TEST(TopicStatistics, UsesRecordTimesWithoutHeaders) {
  TopicStatistics statistics;
  for (int i = 0; i < 10; ++i) statistics.add(i * kPeriod, std::nullopt);
  const TopicInfo info = info_of(statistics);
  EXPECT_FALSE(info.stamped);
  EXPECT_NEAR(info.rate_hz.value(), 200.0, 1e-3);
  EXPECT_FALSE(info.median_offset_s.has_value());
}

TEST(TopicStatistics, DelaysOfAClockSinceBootKeepTheirMilliseconds) {
  TopicStatistics statistics;
  constexpr Duration kDelay = 1'699'992'596'765 * kMillisecond;
  for (int i = 0; i < 20; ++i) statistics.add(i * kPeriod + kDelay, i * kPeriod + 0);
  EXPECT_NEAR(info_of(statistics).median_offset_s.value(), 1'699'992'596.765, 1e-6);
}

TEST(TopicStatistics, StampsThatAreAllZeroAreReplacedByRecordTimes) {
  TopicStatistics statistics;
  for (int i = 0; i < 50; ++i) statistics.add(1'700'000'000 * kSecond + i * kPeriod, 0);
  const TopicInfo info = info_of(statistics);
  EXPECT_TRUE(info.zero_stamps);
  EXPECT_FALSE(info.stamped);
  EXPECT_EQ(info.repeated, 0U);
  EXPECT_NEAR(info.rate_hz.value(), 200.0, 1e-3);
  EXPECT_FALSE(info.median_offset_s);
}

TEST(TopicStatistics, ARecorderClockThatIsSetBackLosesNothing) {
  TopicStatistics statistics;
  std::vector<std::pair<Time, Time>> messages;
  for (int i = 0; i < 2000; ++i) {
    const Time stamp = 1'700'000'000 * kSecond + i * kPeriod;
    messages.emplace_back(stamp + kMillisecond - (i >= 1200 ? 2 * kSecond : 0), stamp);
  }
  std::ranges::stable_sort(messages);
  for (const auto& [record, stamp] : messages) statistics.add(record, stamp);
  const TopicInfo info = info_of(statistics);
  EXPECT_NEAR(info.recorder_step_s, 2.0, 1e-9);
  EXPECT_EQ(info.backwards, 0U);
  EXPECT_EQ(info.loss.value(), 0.0);
}

TEST(TopicStatistics, JitterIsNoLoss) {
  TopicStatistics statistics;
  for (int i = 0; i < 2000; ++i) {
    const Time stamp = i * kPeriod + (i % 2 == 0 ? 0 : 7 * kPeriod / 10) + kPeriod;
    statistics.add(stamp, stamp);
  }
  const TopicInfo info = info_of(statistics);
  EXPECT_NEAR(info.rate_hz.value(), 200.0, 1.0);
  EXPECT_EQ(info.loss.value(), 0.0);
}

TEST(TopicStatistics, OneMessageHasNoRate) {
  TopicStatistics statistics;
  statistics.add(7, 7);
  EXPECT_FALSE(info_of(statistics).rate_hz.has_value());
}

}  // namespace
}  // namespace aims
