// SPDX-License-Identifier: BSD-3-Clause
#include "estimator/filter/imu_history.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace aims {
namespace {

constexpr double kImuHz = 50.0;  // [Hz]
constexpr Duration kPeriod = 20 * kMillisecond;

ImuSample sample(Time stamp, double rate) { return {stamp, {rate, 0.0, 0.0}, {0.0, 0.0, 9.81}}; }

ImuHistory history_of(std::initializer_list<int> periods) {
  ImuHistory history(ImuPropagationConfig{}, kImuHz);
  for (int i : periods) history.insert(sample(i * kPeriod, i));
  return history;
}

std::vector<InertialSegment> segments_of(const ImuHistory& history, Time begin, Time end) {
  std::vector<InertialSegment> segments;
  history.segments(begin, end, segments);
  return segments;
}

TEST(ImuHistory, SegmentsHaveTheMeanOfTheSamplesAtBothEnds) {
  const auto segments = segments_of(history_of({1, 2, 3}), kPeriod, 3 * kPeriod);
  ASSERT_EQ(segments.size(), 2U);
  EXPECT_EQ(segments[0].begin, kPeriod);
  EXPECT_EQ(segments[0].end, 2 * kPeriod);
  EXPECT_DOUBLE_EQ(segments[0].angular_velocity.x(), 1.5);
  EXPECT_DOUBLE_EQ(segments[1].angular_velocity.x(), 2.5);
}

TEST(ImuHistory, ASampleAfterAGapHoldsOverOnePeriod) {
  const auto segments = segments_of(history_of({1, 2}), 0, 2 * kPeriod);
  ASSERT_EQ(segments.size(), 2U);
  EXPECT_TRUE(segments[0].measured);
  EXPECT_DOUBLE_EQ(segments[0].angular_velocity.x(), 1.0);
  EXPECT_DOUBLE_EQ(segments[1].angular_velocity.x(), 1.5);
}

// Every time but the stamps of the samples is on the clock of the LiDAR.
TEST(ImuHistory, ADelayGivesTheSegmentsOfTheShiftedSignal) {
  constexpr Duration kDelay = 7 * kMillisecond;
  ImuHistory late(ImuPropagationConfig{}, kImuHz);
  ImuHistory exact(ImuPropagationConfig{}, kImuHz);
  for (int i : {1, 2, 3, 5, 6, 20}) {
    late.insert(sample(i * kPeriod + kDelay, i * i));
    exact.insert(sample(i * kPeriod, i * i));
  }
  late.set_delay(kDelay);
  const auto expected = segments_of(exact, kPeriod + 5, 21 * kPeriod);
  const auto found = segments_of(late, kPeriod + 5, 21 * kPeriod);
  ASSERT_EQ(found.size(), expected.size());
  for (std::size_t i = 0; i < found.size(); ++i) {
    EXPECT_EQ(found[i].begin, expected[i].begin) << i;
    EXPECT_EQ(found[i].end, expected[i].end) << i;
    EXPECT_EQ(found[i].measured, expected[i].measured) << i;
    EXPECT_EQ(found[i].angular_velocity, expected[i].angular_velocity) << i;
    EXPECT_EQ(found[i].specific_force, expected[i].specific_force) << i;
  }
  EXPECT_EQ(late.newest(), exact.newest());
  EXPECT_EQ(late.angular_velocity_at(2 * kPeriod + 3), exact.angular_velocity_at(2 * kPeriod + 3));
}

TEST(ImuHistory, ForgetsByTheClockOfTheLidar) {
  ImuHistory history(ImuPropagationConfig{}, kImuHz);
  for (int i = 0; i < 100; ++i) history.insert(sample(i * kPeriod, i));
  history.set_delay(kPeriod);
  history.forget_before(20 * kPeriod);
  const auto segments = segments_of(history, 20 * kPeriod, 21 * kPeriod);
  ASSERT_EQ(segments.size(), 1U);
  EXPECT_DOUBLE_EQ(segments[0].angular_velocity.x(), 21.5);
}

TEST(ImuHistory, BridgedSpansAreLessCertain) {
  ImuHistory history(ImuPropagationConfig{}, kImuHz);
  for (int i = 0; i < 100; ++i) history.insert(sample(i * kPeriod, std::sin(0.3 * i)));
  history.observe_noise(110 * kPeriod);
  const auto segments = segments_of(history, 98 * kPeriod, 110 * kPeriod);
  ASSERT_EQ(segments.size(), 2U);
  EXPECT_GT(segments[0].noise.gyro, 0.0);
  EXPECT_GT(segments[1].noise.gyro, 5.0 * segments[0].noise.gyro);
  EXPECT_GE(segments[1].noise.accelerometer, segments[0].noise.accelerometer);
}

TEST(ImuHistory, CutsSegmentsAtTheSpan) {
  const auto segments = segments_of(history_of({1, 2, 3}), kPeriod + 7, 2 * kPeriod + 5);
  ASSERT_EQ(segments.size(), 2U);
  EXPECT_EQ(segments[0].begin, kPeriod + 7);
  EXPECT_EQ(segments[1].end, 2 * kPeriod + 5);
}

TEST(ImuHistory, ALostSampleIsReplacedByTheMeanOfItsNeighbours) {
  const auto segments = segments_of(history_of({1, 2, 4, 5}), 2 * kPeriod, 4 * kPeriod);
  ASSERT_EQ(segments.size(), 2U);
  EXPECT_FALSE(segments[0].measured);
  EXPECT_EQ(segments[0].end, 3 * kPeriod);
  EXPECT_DOUBLE_EQ(segments[0].angular_velocity.x(), 3.0);
  EXPECT_TRUE(segments[1].measured);
}

TEST(ImuHistory, CoversASpanWithoutAnySample) {
  const auto segments = segments_of(ImuHistory(ImuPropagationConfig{}, kImuHz), 0, kSecond);
  ASSERT_EQ(segments.size(), 1U);
  EXPECT_FALSE(segments[0].measured);
  EXPECT_EQ(segments[0].end, kSecond);
}

TEST(ImuHistory, CoversTimeAfterTheNewestSample) {
  const auto segments = segments_of(history_of({1, 2}), kPeriod, 10 * kPeriod);
  ASSERT_EQ(segments.size(), 2U);
  EXPECT_TRUE(segments[0].measured);
  EXPECT_FALSE(segments[1].measured);
  EXPECT_EQ(segments[1].end, 10 * kPeriod);
}

TEST(ImuHistory, SortsLateSamplesAndRejectsDuplicates) {
  ImuHistory history = history_of({1, 3});
  EXPECT_TRUE(history.insert(sample(2 * kPeriod, 2)));
  EXPECT_FALSE(history.insert(sample(2 * kPeriod, 9)));
  EXPECT_EQ(segments_of(history, 0, 3 * kPeriod).size(), 3U);
  EXPECT_EQ(history.angular_velocity_at(2 * kPeriod)->x(), 1.5) << "mean of both ends";
  EXPECT_FALSE(history.angular_velocity_at(4 * kPeriod).has_value());
}

}  // namespace
}  // namespace aims
