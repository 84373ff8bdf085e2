// SPDX-License-Identifier: BSD-3-Clause
// When points fired, where the clouds do not say or say it otherwise.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "recordings/messages/message_types.hpp"
#include "tests/recordings/stream/recorded_deliveries.hpp"
#include "tests/recordings/stream/robot_recording.hpp"

namespace aims {
namespace {

using test::kMounted;
using test::kStart;
using test::RawCloud;
using test::Recording;
using test::RobotRecording;

class CloudTimes : public test::RecordingTest {};

/// A ring of points around the sensor, `sense` +1 from +x to +y, without a time.
RawCloud untimed_cloud(Time stamp, double sense) {
  std::vector<std::array<float, 4>> points;
  for (int i = 0; i < 200; ++i) {
    const double azimuth = sense * 2.0 * std::numbers::pi * i / 200.0;
    points.push_back({static_cast<float>(5.0 * std::cos(azimuth)),
                      static_cast<float>(5.0 * std::sin(azimuth)), 0.0F, 0.0F});
  }
  RawCloud cloud = RawCloud::of(stamp, points);
  cloud.fields.pop_back();
  return cloud;
}

/// Untimed clouds at 10 Hz that arrive `latency` after their stamp.
Recording read_untimed(const std::filesystem::path& bag, double sense, Duration latency,
                       const RecordingConfig& config = {}) {
  std::filesystem::remove(bag);
  RobotRecording robot(bag);
  robot.add_transforms(kMounted);
  robot.add_imu(kStart, 30);
  for (int k = 0; k < 4; ++k) {
    const Time stamp = kStart + k * 100 * kMillisecond;
    robot.add_cloud(untimed_cloud(stamp, sense), stamp + latency);
  }
  robot.close();
  return test::read_recording(bag, config);
}

TEST_F(CloudTimes, PointsWithoutTimeAreTimedByAzimuth) {
  const Recording read = read_untimed(bag(), -1.0, 105 * kMillisecond);
  const auto scans = test::scans_of(read.deliveries);
  ASSERT_EQ(scans.size(), 4U);
  EXPECT_EQ(scans[1]->stamp, kStart + 100 * kMillisecond);
  EXPECT_EQ(scans[1]->end, kStart + 200 * kMillisecond);
  EXPECT_FALSE(read.noted("opposite direction"));
  for (std::size_t i = 0; i < 200; ++i) {
    ASSERT_NEAR(scans[1]->points[i].time_offset_ns, 5e5 * static_cast<double>(i), 100.0);
  }
}

TEST_F(CloudTimes, AWrongDirectionOfSpinIsNotedAndConfigurable) {
  EXPECT_TRUE(read_untimed(bag(), 1.0, 105 * kMillisecond)
                  .noted("azimuths change in the opposite direction from point to point: set "
                         "lidar_clockwise: false"));
  RecordingConfig config;
  config.lidar_clockwise = false;
  const Recording read = read_untimed(bag(), 1.0, 105 * kMillisecond, config);
  EXPECT_FALSE(read.noted("opposite direction"));
  EXPECT_NEAR(test::scans_of(read.deliveries)[2]->points[50].time_offset_ns, 25e6, 100.0);
}

TEST_F(CloudTimes, ACloudThatArrivesTooEarlyIsStampedAtItsEnd) {
  const Recording early = read_untimed(bag(), -1.0, 5 * kMillisecond);
  EXPECT_TRUE(early.noted("clouds arrive 5.0 ms after their stamp"));
  EXPECT_EQ(test::scans_of(early.deliveries)[1]->stamp, kStart);
  EXPECT_EQ(test::scans_of(early.deliveries)[1]->end, kStart + 100 * kMillisecond);
  // Record times that are copies of the stamps tell nothing.
  const Recording copied = read_untimed(bag(), -1.0, 0);
  EXPECT_EQ(test::scans_of(copied.deliveries)[1]->stamp, kStart + 100 * kMillisecond);
  RecordingConfig config;
  config.cloud_stamp = CloudStamp::kStart;
  const Recording told = read_untimed(bag(), -1.0, 5 * kMillisecond, config);
  EXPECT_EQ(test::scans_of(told.deliveries)[1]->stamp, kStart + 100 * kMillisecond);
}

TEST_F(CloudTimes, TimesFromTheStartOfAScanMayHaveTheStampAtItsEnd) {
  RobotRecording robot(bag());
  robot.add_imu(kStart, 30);
  robot.add_clouds(kStart, 4);
  robot.close();
  RecordingConfig config;
  config.cloud_stamp = CloudStamp::kEnd;
  const auto scans = test::scans_of(test::read_recording(bag(), config).deliveries);
  ASSERT_EQ(scans.size(), 4U);
  EXPECT_EQ(scans[2]->stamp, kStart + 100 * kMillisecond);
  EXPECT_EQ(scans[2]->end, kStart + 200 * kMillisecond);
  EXPECT_NEAR(scans[2]->points.back().time_offset_ns, 90e6, 5.0);  // float32 seconds
}

}  // namespace
}  // namespace aims
