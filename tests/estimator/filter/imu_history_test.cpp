// SPDX-License-Identifier: BSD-3-Clause
#include "estimator/filter/imu_history.hpp"

#include <gtest/gtest.h>

namespace aims {
namespace {

constexpr double kRate = 50.0;  // [Hz]
constexpr Duration kPeriod = 20 * kMillisecond;

ImuSample sample(Time stamp, double rate) { return {stamp, {rate, 0.0, 0.0}, {0.0, 0.0, 9.81}}; }

ImuHistory history_of(std::initializer_list<int> periods,
                      ImuSampling sampling = ImuSampling::kMean) {
  ImuPropagationConfig config;
  config.sampling = sampling;
  ImuHistory history(config, kRate);
  for (int i : periods) history.insert(sample(i * kPeriod, i));
  return history;
}

std::vector<InertialSegment> segments_of(const ImuHistory& history, Time begin, Time end) {
  std::vector<InertialSegment> segments;
  history.segments(begin, end, segments);
  return segments;
}

TEST(ImuHistory, SampleHoldsOverTheIntervalThatEndsAtItsStamp) {
  const auto segments = segments_of(history_of({1, 2, 3}), kPeriod, 3 * kPeriod);
  ASSERT_EQ(segments.size(), 2U);
  EXPECT_EQ(segments[0].begin, kPeriod);
  EXPECT_EQ(segments[0].end, 2 * kPeriod);
  EXPECT_EQ(segments[0].angular_velocity.x(), 2.0);
  EXPECT_EQ(segments[1].angular_velocity.x(), 3.0);
}

TEST(ImuHistory, PointSamplesGiveTheMeanOfBothEnds) {
  const auto segments =
      segments_of(history_of({1, 2, 3}, ImuSampling::kPoint), kPeriod, 2 * kPeriod);
  ASSERT_EQ(segments.size(), 1U);
  EXPECT_DOUBLE_EQ(segments[0].angular_velocity.x(), 1.5);
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
  const auto segments = segments_of(ImuHistory(ImuPropagationConfig{}, kRate), 0, kSecond);
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
  EXPECT_EQ(history.angular_velocity_at(2 * kPeriod)->x(), 2.0);
  EXPECT_FALSE(history.angular_velocity_at(4 * kPeriod).has_value());
}

}  // namespace
}  // namespace aims
