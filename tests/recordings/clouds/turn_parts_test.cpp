// SPDX-License-Identifier: BSD-3-Clause
// Clouds that are parts of a turn.
#include "recordings/clouds/turn_parts.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "tests/recordings/stream/recorded_deliveries.hpp"
#include "tests/recordings/stream/robot_recording.hpp"

namespace aims {
namespace {

using test::kMounted;
using test::kStart;
using test::RawCloud;
using test::Recording;
using test::RobotRecording;

constexpr int kColumns = 360;
constexpr Duration kTurn = kSecond / 10;

/// Return of a column of a turn, with its time after `zero`.
std::array<float, 4> point_of(int column, double sense, Duration zero) {
  const double azimuth = sense * 2.0 * std::numbers::pi * column / kColumns;
  const double time = 1e-9 * static_cast<double>(column * kTurn / kColumns - zero);
  return {static_cast<float>(5.0 * std::cos(azimuth)), static_cast<float>(5.0 * std::sin(azimuth)),
          0.0F, static_cast<float>(time)};
}

class TurnPartsTest : public test::RecordingTest {
 protected:
  /// Ten turns, each in so many clouds; `lost`: one of the parts of the fifth turn.
  Recording read(int parts, double sense = 1.0, bool timed = true, bool lost = false) const {
    std::filesystem::remove(bag());
    RobotRecording robot(bag());
    robot.add_transforms(kMounted);
    robot.add_imu(kStart, 100);
    for (int part = 0; part < 10 * parts; ++part) {
      const int first = part % parts * kColumns / parts;
      const Duration zero = first * kTurn / kColumns;
      std::vector<std::array<float, 4>> points;
      for (int i = 0; i < kColumns / parts; ++i) points.push_back(point_of(first + i, sense, zero));
      const Time stamp = kStart + part / parts * kTurn + zero;
      RawCloud cloud = RawCloud::of(stamp, points);
      if (!timed) cloud.fields.pop_back();
      if (lost && part == 5 * parts + 3) continue;
      robot.add_cloud(cloud, stamp + kTurn / parts);
    }
    robot.close();
    RecordingConfig config;
    config.lidar_clockwise = sense < 0.0;
    return test::read_recording(bag(), config);
  }
};

TEST_F(TurnPartsTest, AreJoinedToTheScansOfWholeClouds) {
  for (const bool timed : {true, false}) {
    for (const double sense : {1.0, -1.0}) {
      const Recording whole = read(1, sense, timed);
      const auto expected = test::scans_of(whole.deliveries);
      ASSERT_EQ(expected.size(), 10U) << whole.error;
      EXPECT_FALSE(whole.noted("part of a turn"));
      for (const int parts : {2, 4, 20}) {
        const Recording joined = read(parts, sense, timed);
        EXPECT_TRUE(joined.noted("each cloud is a part of a turn")) << parts;
        const auto scans = test::scans_of(joined.deliveries);
        ASSERT_EQ(scans.size(), expected.size()) << parts;
        for (std::size_t i = 0; i < scans.size(); ++i) {
          ASSERT_EQ(scans[i]->points.size(), std::size_t{kColumns});
          EXPECT_EQ(scans[i]->stamp, expected[i]->stamp);
          EXPECT_NEAR(to_seconds(scans[i]->end - expected[i]->end), 0.0, 1e-3);
          for (std::size_t k = 0; k < scans[i]->points.size(); ++k) {
            const LidarPoint &a = scans[i]->points[k], &b = expected[i]->points[k];
            EXPECT_EQ(a.position, b.position);
            EXPECT_NEAR(a.time_offset_ns, b.time_offset_ns, timed ? 100 : 300'000);
          }
        }
      }
    }
  }
}

TEST_F(TurnPartsTest, ALostPartLeavesAHole) {
  const auto scans = test::scans_of(read(20, 1.0, true, true).deliveries);
  ASSERT_EQ(scans.size(), 10U);
  EXPECT_EQ(scans[5]->points.size(), std::size_t{kColumns} * 19 / 20);
  EXPECT_EQ(scans[6]->points.size(), std::size_t{kColumns});
}

TEST(TurnPartFinder, ALidarThatLooksAheadHasNoParts) {
  TurnPartFinder finder;
  for (int cloud = 0; cloud < 30; ++cloud) {
    finder.begin();
    for (int i = -30; i <= 30; ++i) {
      const double azimuth = 0.02 * i + 0.05 * std::sin(1.7 * cloud);
      finder.add({5.0 * std::cos(azimuth), 5.0 * std::sin(azimuth), 0.0});
    }
  }
  EXPECT_EQ(finder.find().count, 1);
}

}  // namespace
}  // namespace aims
