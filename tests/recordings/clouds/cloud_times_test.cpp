// SPDX-License-Identifier: BSD-3-Clause
// When points fired, where the clouds do not say or say it otherwise.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <functional>
#include <numbers>
#include <tuple>
#include <utility>

#include "recordings/inspection/bag_check.hpp"
#include "recordings/inspection/bag_info.hpp"
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

/// What a LiDAR sees of its turns, and how.
struct Turns {
  double from = 0.0, to = 1.0;  ///< the part that it sees
  double scale = 1.0;           ///< of the point times
  int kept = 1;                 ///< one of so many clouds
  int lost = 0;                 ///< one of so many of the kept; 0: none
};

/// Forty clouds of a LiDAR of 10 Hz.
Recording read_turns(const std::filesystem::path& bag, const Turns& turns,
                     const RecordingConfig& config = {}) {
  std::filesystem::remove(bag);
  RobotRecording robot(bag);
  robot.add_transforms(kMounted);
  robot.add_imu(kStart, 60 * turns.kept * 4);
  for (int k = 0; k < 40 * turns.kept; ++k) {
    if (k % turns.kept != 0) continue;
    if (turns.lost > 0 && k / turns.kept % turns.lost == 1) continue;
    std::vector<std::array<float, 4>> points;
    for (int i = 0; i < 200; ++i) {
      const double turned = turns.from + (turns.to - turns.from) * i / 200.0;
      const double azimuth = 2.0 * std::numbers::pi * turned;
      points.push_back({static_cast<float>(5.0 * std::cos(azimuth)),
                        static_cast<float>(5.0 * std::sin(azimuth)), 0.0F,
                        static_cast<float>(0.1 * turns.scale * turned)});
    }
    const Time stamp = kStart + k * 100 * kMillisecond;
    robot.add_cloud(RawCloud::of(stamp, points), stamp + 105 * kMillisecond);
  }
  robot.close();
  return test::read_recording(bag, config);
}

TEST_F(CloudTimes, ALidarThatIsBlindBehindMissesNoClouds) {
  for (const auto& [from, to] : {std::pair(0.0, 0.5), {0.25, 0.6}, {0.1, 0.7}, {0.0, 1.0}}) {
    const Recording whole = read_turns(bag(), {.from = from, .to = to});
    EXPECT_FALSE(whole.noted("are missing") || whole.noted(" spans ")) << from;
    const Recording lossy = read_turns(bag(), {.from = from, .to = to, .lost = 4});
    EXPECT_TRUE(lossy.noted("/points: 10 of 40 messages are missing")) << from;
    EXPECT_FALSE(lossy.noted(" spans ")) << from;
  }
}

TEST_F(CloudTimes, PointTimesOfAnotherScaleAreNamed) {
  const Recording twice = read_turns(bag(), {.scale = 2.0});
  EXPECT_TRUE(
      twice.noted("a turn takes 0.2 s, but by the azimuths of clouds that come every 0.1 s"));
  for (const double scale : {0.5, 0.1}) {
    const Recording less = read_turns(bag(), {.scale = scale});
    EXPECT_TRUE(less.noted(", but clouds come every 0.1 s: were those between them left out"));
    EXPECT_FALSE(less.noted("are missing")) << scale;
  }
}

TEST_F(CloudTimes, PointTimesThatTheAzimuthsContradictAreNamed) {
  for (const auto& [from, to] : {std::pair(0.0, 1.0), {0.25, 0.6}, {0.1, 0.7}}) {
    for (const int lost : {0, 4}) {
      for (const double scale : {0.7, 1.0, 1.2, 1.5}) {
        const Recording read =
            read_turns(bag(), {.from = from, .to = to, .scale = scale, .lost = lost});
        EXPECT_EQ(read.noted("the times are perhaps " + fmt::format("{:.2g}", scale) +
                             " times the true ones"),
                  scale != 1.0)
            << from << ' ' << lost << ' ' << scale;
        EXPECT_EQ(read.noted("times the true ones"), scale != 1.0) << from << ' ' << scale;
        EXPECT_FALSE(read.noted("run backwards"));
      }
    }
  }
}

TEST_F(CloudTimes, PointTimesThatRunBackwardsAreNamedAndAzimuthsMayServe) {
  const Turns backwards = {.scale = -1.0};
  EXPECT_TRUE(read_turns(bag(), {.scale = -10.0}).noted("'time' falls from point to point"))
      << "a fraction of the scan";
  EXPECT_TRUE(read_turns(bag(), backwards).noted("'time' falls from point to point of each ring"));
  const auto info = bag_info(bag(), {}, {});
  ASSERT_TRUE(info);
  const auto is_named = [](const RequirementCheck& each) {
    return each.requirement == "time of each point" && each.fulfilment == Fulfilment::kPoor;
  };
  EXPECT_TRUE(std::ranges::any_of(check_bag(*info), is_named));
  RecordingConfig config;
  config.point_time_unit = PointTimeUnit::kNone;
  config.lidar_clockwise = false;
  const Recording by_azimuth = read_turns(bag(), backwards, config);
  EXPECT_TRUE(by_azimuth.noted("times of points do not serve: derived from azimuth"));
  EXPECT_FALSE(by_azimuth.noted("falls from point to point"));
  const auto scans = test::scans_of(by_azimuth.deliveries);
  EXPECT_EQ(scans.at(2)->stamp, kStart + 200 * kMillisecond);
  EXPECT_NEAR(scans.at(2)->points.at(50).time_offset_ns, 25e6, 1e3);
}

TEST_F(CloudTimes, CloudsThatAreLeftOutOnPurposeAreNotLost) {
  const Recording fewer = read_turns(bag(), {.kept = 2});
  EXPECT_TRUE(fewer.noted("spans 0.0995 s, but clouds come every 0.2 s"));
  EXPECT_FALSE(fewer.noted("are missing"));
  EXPECT_EQ(test::scans_of(fewer.deliveries)[1]->end, kStart + 300 * kMillisecond);
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

/// The bytes of a number in place of the float32 time of a point.
void put_time(RawCloud& cloud, std::size_t point, std::uint32_t value) {
  std::memcpy(cloud.data.data() + point * cloud.point_step + 12, &value, sizeof(value));
}

/// Clouds of ten points over 90 ms at 10 Hz whose uint32 time is a clock in ns that was `at_start`
/// when the first one fired; those of which `unset` holds have the time 0 throughout.
Recording read_counted(
    const std::filesystem::path& bag, std::uint32_t at_start,
    const std::function<bool(int)>& unset = [](int) { return false; }) {
  std::filesystem::remove(bag);
  RobotRecording robot(bag);
  robot.add_transforms(kMounted);
  robot.add_imu(kStart, 120);
  for (int k = 0; k < 20; ++k) {
    const Time stamp = kStart + k * 100 * kMillisecond;
    const float noise = 1e-3F * static_cast<float>(k % 7);
    const std::array<float, 4> point = {4, 2 + noise, 1, 0};
    RawCloud cloud = RawCloud::of(stamp, std::vector<std::array<float, 4>>(200, point));
    cloud.fields.back().type = 6;
    for (std::size_t i = 0; i < 200; ++i) {
      const auto after = static_cast<std::uint32_t>(i * 450'000);
      const auto fired = at_start + static_cast<std::uint32_t>(k) * 100'000'000U + after;
      put_time(cloud, i, unset(k) ? 0 : fired);
    }
    robot.add_cloud(cloud, stamp + 105 * kMillisecond);
  }
  robot.close();
  return test::read_recording(bag);
}

TEST_F(CloudTimes, CountersSincePowerOnAreAClockWhateverTheirSizeAndBeginAgain) {
  // Small, and 0.35 s before it passes 2^32.
  for (const std::uint32_t at_start : {50'000'000U, 4'294'967'295U - 350'000'000U}) {
    const Recording read = read_counted(bag(), at_start);
    ASSERT_EQ(read.error, "");
    EXPECT_TRUE(read.counts.empty()) << read.counts.begin()->first;
    const auto scans = test::scans_of(read.deliveries);
    ASSERT_EQ(scans.size(), 20U);
    for (int k = 0; k < 20; ++k) {
      const LidarScan& scan = *scans[static_cast<std::size_t>(k)];
      EXPECT_EQ(scan.stamp, kStart + k * 100 * kMillisecond);
      ASSERT_EQ(scan.points.size(), 200U);
      EXPECT_EQ(scan.points.back().time_offset_ns, 199 * 450'000);
    }
  }
}

TEST_F(CloudTimes, CloudsWhosePointsHaveOneTimeAreCounted) {
  const Recording read = read_counted(bag(), 50'000'000U, [](int k) { return k % 4 == 3; });
  EXPECT_EQ(read.counts.at("cloud_without_times"), 5);
}

TEST_F(CloudTimes, ADirectionOfSpinShowsInFiringOrderToo) {
  // Columns of four rings, each column counter-clockwise of the one before.
  RobotRecording robot(bag());
  robot.add_transforms(kMounted);
  robot.add_imu(kStart, 30);
  for (int k = 0; k < 4; ++k) {
    std::vector<std::array<float, 4>> points;
    for (int i = 0; i < 800; ++i) {
      const double azimuth = 2.0 * std::numbers::pi * (i / 4) / 200.0;
      const double noise = 1e-7 * (i * 37 % 11);
      points.push_back({static_cast<float>(5.0 * std::cos(azimuth + noise)),
                        static_cast<float>(5.0 * std::sin(azimuth + noise)),
                        0.5F * static_cast<float>(i % 4), 0.0F});
    }
    RawCloud cloud = RawCloud::of(kStart + k * 100 * kMillisecond, points);
    cloud.fields.pop_back();
    robot.add_cloud(cloud, cloud.stamp + 105 * kMillisecond);
  }
  robot.close();
  EXPECT_TRUE(test::read_recording(bag()).noted("set lidar_clockwise: false"));
}

TEST_F(CloudTimes, CloudsWithoutStampsAreRecordedAtTheEndOfTheirScan) {
  RobotRecording robot(bag());
  robot.add_transforms(kMounted);
  robot.add_imu(kStart, 60);
  for (int k = 0; k < 10; ++k) {
    const Time end = kStart + (k + 1) * 100 * kMillisecond;
    robot.add_cloud(RawCloud::of(0, {{4, 0, 0, 0}, {4, 0, 1, 0.05F}, {4, 0, 2, 0.1F}}), end);
  }
  robot.close();
  const Recording read = test::read_recording(bag());
  EXPECT_TRUE(read.noted("their record times serve, as the end of the scans"));
  const auto scans = test::scans_of(read.deliveries);
  ASSERT_EQ(scans.size(), 10U);
  EXPECT_EQ(scans[3]->stamp, kStart + 300 * kMillisecond);
  EXPECT_NEAR(static_cast<double>(scans[3]->end - kStart), 400e6, 10.0) << "times are floats";
  EXPECT_NEAR(scans[3]->points[1].time_offset_ns, 50e6, 10.0);
}

TEST_F(CloudTimes, TimesThatAreTooLongDecideNothingElse) {
  const Recording read = read_timed(bag(), 0.7F, 105 * kMillisecond, 0.02F);
  EXPECT_TRUE(read.noted("spans 0.68 s, but a cloud comes every 0.1 s"));
  EXPECT_FALSE(read.noted("the stamp is taken as the end"));
  EXPECT_EQ(test::scans_of(read.deliveries)[2]->stamp, kStart + 200 * kMillisecond);
}

/// Clouds of three rings of many points, whose field says `ring(point)`.
Recording read_rings(const std::filesystem::path& bag,
                     const std::function<std::uint16_t(std::size_t)>& ring) {
  std::filesystem::remove(bag);
  RobotRecording robot(bag);
  robot.add_transforms(kMounted);
  robot.add_imu(kStart, 60);
  for (int k = 0; k < 10; ++k) {
    std::vector<std::array<float, 4>> points;
    for (int i = 0; i < 90; ++i) {
      points.push_back({4, 0, static_cast<float>(i % 3), 0.001F * static_cast<float>(i)});
    }
    RawCloud cloud = RawCloud::of(kStart + k * 100 * kMillisecond, points);
    cloud.fields.push_back({"ring", 16, 4});
    cloud.point_step = 18;
    cloud.row_step = 18 * 90;
    std::vector<std::byte> wider(cloud.row_step);
    for (std::size_t i = 0; i < 90; ++i) {
      std::copy_n(&cloud.data[16 * i], 16, &wider[18 * i]);
      const std::uint16_t number = ring(i);
      std::memcpy(&wider[18 * i + 16], &number, sizeof(number));
    }
    cloud.data = wider;
    robot.add_cloud(cloud, cloud.stamp + 105 * kMillisecond);
  }
  robot.close();
  return test::read_recording(bag);
}

TEST_F(CloudTimes, NumbersThatAreNoRingsGiveWayToElevations) {
  const auto unknown = [](std::size_t) { return std::uint16_t{65535}; };
  const auto returns = [](std::size_t i) { return static_cast<std::uint16_t>(i / 3 % 2); };
  for (const auto& [ring, text] :
       {std::pair<std::function<std::uint16_t(std::size_t)>, const char*>(
            unknown, "the same for all points"),
        {returns, "does not go with the elevations"}}) {
    const Recording read = read_rings(bag(), ring);
    EXPECT_TRUE(read.noted(text));
    EXPECT_EQ(read.setup.rings.count, 3);
    const auto scans = test::scans_of(read.deliveries);
    for (std::size_t i = 0; i < 90; ++i) ASSERT_EQ(scans[0]->points[i].ring, i % 3);
  }
  const Recording right = read_rings(bag(), [](std::size_t i) { return std::uint16_t(i % 3); });
  EXPECT_FALSE(right.noted("it is no ring"));
}

}  // namespace
}  // namespace aims
