// SPDX-License-Identifier: BSD-3-Clause
#include "bench/metrics/segments.hpp"

#include <gtest/gtest.h>

#include "tests/bench/metrics/trajectories.hpp"

namespace aims {
namespace {

std::vector<SegmentDistance> distances_of(const Trajectory& estimate, Duration edge = kSecond) {
  return segment_distances(estimate, test::true_walk(), segments_of(test::walk_waypoint_times()),
                           1.0, {.edge = edge, .gap = 2 * kSecond});
}

TEST(Segments, AreNamedByTheirPoints) {
  const std::vector<WaypointTime> waypoint_times = {
      {"a", 0}, {"b", 1}, {"a", 2}, {"b", 3}, {"c", 4}};
  const auto segments = segments_of(waypoint_times);
  ASSERT_EQ(segments.size(), 4U);
  EXPECT_EQ(segments[0].name, "a-b");
  EXPECT_EQ(segments[1].name, "b-a");
  EXPECT_EQ(segments[2].name, "a-b#2");
  EXPECT_EQ(segments[3].name, "b-c");
  EXPECT_TRUE(segments_of({}).empty());
}

TEST(Segments, MaySkipPointsInBetween) {
  const std::vector<WaypointTime> waypoint_times = {
      {"a", 0}, {"b", 1}, {"d", 2}, {"f", 3}, {"h", 4}, {"f", 5}, {"d", 6}, {"b", 7}, {"a", 8}};
  const std::vector<std::string> names = {"h-d", "a-d", "d-h", "d-a"};
  const auto segments = segments_named(waypoint_times, names);
  ASSERT_EQ(segments.size(), 4U);
  EXPECT_EQ(segments[0].name, "a-d");
  EXPECT_EQ(segments[0].begin, 0);
  EXPECT_EQ(segments[0].end, 2);
  EXPECT_EQ(segments[1].name, "d-h");
  EXPECT_EQ(segments[1].begin, 2);
  EXPECT_EQ(segments[2].name, "h-d");
  EXPECT_EQ(segments[2].end, 6);
  EXPECT_EQ(segments[3].name, "d-a") << "from the last time at d, not the first";
  EXPECT_EQ(segments[3].begin, 6);
  EXPECT_EQ(segments[3].end, 8);
  EXPECT_TRUE(segments_named(waypoint_times, std::vector<std::string>{"a-x"}).empty());
}

TEST(Segments, OfTheSameNameAreNumbered) {
  const std::vector<WaypointTime> waypoint_times = {{"a", 0}, {"b", 1}, {"a", 2}, {"b", 3}};
  const auto segments = segments_named(waypoint_times, std::vector<std::string>{"a-b"});
  ASSERT_EQ(segments.size(), 2U);
  EXPECT_EQ(segments[1].name, "a-b#2");
}

TEST(MList, OfAPerfectEstimateIsZeroInAnyFrame) {
  const auto distances = distances_of(test::perfect_walk());
  ASSERT_FALSE(distances.empty());
  for (const SegmentDistance& each : distances) {
    EXPECT_NEAR(each.true_distance_m, test::kLength, 1e-9);
    EXPECT_NEAR(each.percent.value(), 0.0, 1e-9);
  }
}

TEST(MList, OfAScaleErrorIsTheScaleWithItsSign) {
  for (const double scale : {-0.03, 0.02}) {
    const auto estimate = test::estimated_walk([scale](double, Pose pose) {
      pose.translation *= 1.0 + scale;
      return pose;
    });
    const auto distances = distances_of(estimate);
    ASSERT_EQ(distances.size(), 2U);
    for (const SegmentDistance& each : distances) {
      EXPECT_NEAR(each.signed_percent.value(), 100.0 * scale, 1e-9);
      EXPECT_NEAR(each.percent.value(), 100.0 * std::abs(scale), 1e-9);
    }
    EXPECT_NEAR(m_list_percent(distances).value(), 100.0 * std::abs(scale), 1e-9);
  }
}

TEST(MList, DoesNotLetOppositeErrorsCancel) {
  // 4 % short on the way there, 4 % long on the way back.
  const auto estimate = test::estimated_walk([](double t, Pose pose) {
    const double walked = t < test::kBackFrom ? 0.0 : test::kLength - pose.translation.x();
    const double before =
        std::min(t < test::kBackFrom ? pose.translation.x() : test::kLength, test::kLength);
    pose.translation.x() = 0.96 * before - 1.04 * walked;
    return pose;
  });
  const auto distances = distances_of(estimate);
  EXPECT_NEAR(distances[0].signed_percent.value(), -4.0, 1e-9);
  EXPECT_NEAR(distances[1].signed_percent.value(), 4.0, 1e-9);
  EXPECT_NEAR(m_list_percent(distances).value(), 4.0, 1e-9);
}

TEST(MList, ComparesBothAtTheEstimatesEndsWhenItFallsShort) {
  Trajectory estimate = test::perfect_walk();
  estimate.resize(estimate.size() - 5);
  const auto distances = distances_of(estimate);
  EXPECT_NEAR(distances[1].true_distance_m, test::kLength - 0.5, 1e-9);
  EXPECT_NEAR(distances[1].signed_percent.value(), 0.0, 1e-9);
}

TEST(MList, HasNoValueWhereTheEstimateIsMissing) {
  Trajectory estimate = test::perfect_walk();
  estimate.resize(estimate.size() / 2);
  const auto distances = distances_of(estimate);
  ASSERT_EQ(distances.size(), 2U);
  EXPECT_TRUE(distances[0].percent);
  EXPECT_FALSE(distances[1].percent);
  EXPECT_FALSE(distances[1].signed_percent);
  EXPECT_NEAR(distances[1].true_distance_m, test::kLength, 1e-9);
  EXPECT_FALSE(m_list_percent(distances));
  EXPECT_FALSE(m_list_percent({}));
}

TEST(MList, NeedsPosesNearTheEndsOfASegment) {
  Trajectory estimate = test::perfect_walk();
  const Time there = from_seconds(test::kThere);
  std::erase_if(estimate, [there](const StampedPose& each) {
    return std::abs(each.stamp - there) < 3 * kSecond;
  });
  const auto distances = distances_of(estimate);
  ASSERT_FALSE(distances.empty());
  EXPECT_FALSE(distances[0].estimated_distance_m) << "interpolated over a gap of 6 s at its end";
  EXPECT_FALSE(m_list_percent(distances));
}

TEST(MList, LeavesOutATurnOnTheSpot) {
  const std::vector<WaypointTime> waypoint_times = {{"a", 0},
                                                    {"b", from_seconds(test::kThere)},
                                                    {"b2", from_seconds(test::kBackFrom)},
                                                    {"a", from_seconds(test::kEnd)}};
  const auto distances =
      segment_distances(test::perfect_walk(), test::true_walk(), segments_of(waypoint_times), 1.0,
                        {.edge = kSecond, .gap = 2 * kSecond});
  ASSERT_EQ(distances.size(), 2U);
  EXPECT_EQ(distances[1].segment.name, "b2-a");
}

}  // namespace
}  // namespace aims
