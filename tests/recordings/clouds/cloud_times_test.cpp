// SPDX-License-Identifier: BSD-3-Clause
// When points fired, where the clouds do not say or say it otherwise.
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <numbers>
#include <tuple>

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

TEST_F(CloudTimes, CoordinatesInCentimetresOrMillimetresAreNamedAndConverted) {
  for (const auto& [unit, name, scale] :
       {std::tuple(PointUnit::kCentimetres, "cm", 100.0F), {PointUnit::kMillimetres, "mm", 1e3F}}) {
    std::filesystem::remove(bag());
    RobotRecording robot(bag());
    robot.add_transforms(kMounted);
    robot.add_imu(kStart, 30);
    for (int k = 0; k < 4; ++k) {
      const Time stamp = kStart + k * 100 * kMillisecond;
      RawCloud cloud = untimed_cloud(stamp, 1.0);
      for (std::size_t i = 0; i < 200; ++i) {
        std::array<float, 3> p;
        std::memcpy(p.data(), cloud.data.data() + i * cloud.point_step, sizeof(p));
        for (float& each : p) each *= scale;
        std::memcpy(cloud.data.data() + i * cloud.point_step, p.data(), sizeof(p));
      }
      robot.add_cloud(cloud, stamp + 110 * kMillisecond);
    }
    robot.close();
    EXPECT_TRUE(test::read_recording(bag()).noted(std::string("recording.point_unit=") + name));
    RecordingConfig config;
    config.point_unit = unit;
    const Recording right = test::read_recording(bag(), config);
    EXPECT_FALSE(right.noted("half of the points are farther"));
    EXPECT_NEAR(test::scans_of(right.deliveries).at(0)->points.at(0).position.norm(), 5.0F, 1e-4F);
  }
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

/// Clouds of eight points at 10 Hz whose times run to `last`, recorded `latency` after their stamp.
Recording read_timed(const std::filesystem::path& bag, float last, Duration latency,
                     float first = 0.0F) {
  RobotRecording robot(bag);
  robot.add_transforms(kMounted);
  robot.add_imu(kStart, 60);
  for (int k = 0; k < 10; ++k) {
    std::vector<std::array<float, 4>> points;
    for (int i = 0; i < 8; ++i) {
      const auto turn = static_cast<float>(i);
      points.push_back({4.0F - turn, 2.0F, 0.1F * turn, first + (last - first) / 7.0F * turn});
    }
    const Time stamp = kStart + k * 100 * kMillisecond;
    robot.add_cloud(RawCloud::of(stamp, points), stamp + latency);
  }
  robot.close();
  return test::read_recording(bag);
}

TEST_F(CloudTimes, TimesFromZeroToOneAreFractionsOfTheScan) {
  const Recording read = read_timed(bag(), 1.0F, 105 * kMillisecond);
  EXPECT_TRUE(read.noted("runs from 0 to 1 over scans of 0.1 s"));
  ASSERT_EQ(read.setup.warnings.size(), 1U);
  const auto scans = test::scans_of(read.deliveries);
  EXPECT_EQ(scans[2]->stamp, kStart + 200 * kMillisecond);
  EXPECT_NEAR(scans[2]->points[7].time_offset_ns, 100e6, 20.0);
}

TEST_F(CloudTimes, TimesFromMinusOneToZeroAreFractionsBeforeTheEndOfTheScan) {
  const Recording read = read_timed(bag(), 0.0F, 5 * kMillisecond, -1.0F);
  EXPECT_TRUE(read.noted("runs from -1 to 0 over scans of 0.1 s"));
  EXPECT_TRUE(read.noted("it marks the end of the scan"));
  const auto scans = test::scans_of(read.deliveries);
  EXPECT_EQ(scans[2]->stamp, kStart + 100 * kMillisecond);
  EXPECT_NEAR(scans[2]->points[7].time_offset_ns, 100e6, 20.0);
}

TEST_F(CloudTimes, ACloudThatArrivesBeforeItsPointsFireIsStampedAtItsEnd) {
  const Recording read = read_timed(bag(), 0.1F, kMillisecond);
  EXPECT_TRUE(read.noted("the stamp is taken as the end of the scan"));
  ASSERT_EQ(read.setup.warnings.size(), 1U);
  EXPECT_EQ(test::scans_of(read.deliveries)[2]->stamp, kStart + 100 * kMillisecond);
}

TEST_F(CloudTimes, ARingThatIsTheSameForAllPointsIsDerivedFromElevation) {
  RobotRecording robot(bag());
  robot.add_transforms(kMounted);
  robot.add_imu(kStart, 60);
  for (int k = 0; k < 10; ++k) {
    RawCloud cloud = RawCloud::of(kStart + k * 100 * kMillisecond,
                                  {{4, 0, 0, 0}, {4, 0, 1, 0.05F}, {4, 0, 2, 0.09F}});
    cloud.fields.push_back({"ring", 16, 4});
    cloud.point_step = 18;
    cloud.row_step = 54;
    std::vector<std::byte> wider(54);
    for (std::size_t i = 0; i < 3; ++i) std::copy_n(&cloud.data[16 * i], 16, &wider[18 * i]);
    cloud.data = wider;
    robot.add_cloud(cloud, cloud.stamp + 105 * kMillisecond);
  }
  robot.close();
  const Recording read = test::read_recording(bag());
  EXPECT_TRUE(read.noted("'ring' is the same for all points: it is no ring"));
  EXPECT_EQ(read.setup.rings.count, 3);
  const auto scans = test::scans_of(read.deliveries);
  for (std::uint16_t i = 0; i < 3; ++i) EXPECT_EQ(scans[0]->points[i].ring, i);
}

}  // namespace
}  // namespace aims
