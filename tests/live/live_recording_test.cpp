// SPDX-License-Identifier: BSD-3-Clause
#include "live/live_recording.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <optional>
#include <string>
#include <variant>

#include "recordings/stream/recording_writer.hpp"
#include "tests/live/played_transport.hpp"
#include "tests/recordings/stream/recorded_deliveries.hpp"
#include "tests/support/kinematic_world.hpp"
#include "tests/support/temporary_folder.hpp"

namespace aims {
namespace {

/// A walk whose LiDAR is switched on in the middle of a turn, when the robot has stood for a while;
/// its first cloud, of which two thirds are missing, is the last message of that second.
void record_late_lidar(const std::filesystem::path& file) {
  test::KinematicWorld world(test::short_walk());
  auto writer = RecordingWriter::create(file, world.rig(), "seed: 1");
  ASSERT_TRUE(writer) << writer.error().message;
  std::optional<Time> start, first_cloud;
  for (const Delivery& each : test::record(world)) {
    if (!start) start = each.arrival;
    if (const auto* imu = std::get_if<ImuSample>(&each.measurement)) {
      ASSERT_TRUE(writer->write_imu(ImuOutput::kMain, each.arrival, *imu));
    } else if (const auto* legs = std::get_if<LegOdometrySample>(&each.measurement)) {
      ASSERT_TRUE(writer->write_legs(each.arrival, *legs));
    } else if (each.arrival > *start + 2900 * kMillisecond) {
      LidarScan scan = *std::get<LidarScanPtr>(each.measurement);
      if (!first_cloud) scan.points.resize(scan.points.size() / 3);
      first_cloud = first_cloud.value_or(each.arrival);
      ASSERT_TRUE(writer->write_scan(each.arrival, scan));
    }
  }
  ASSERT_TRUE(writer->close());
}

TEST(LiveRecording, ALidarThatStartsLateLosesNoClouds) {
  const TemporaryFolder folder;
  const auto file = folder.path() / "late.bag";
  record_late_lidar(file);
  test::PlayedTransport transport(file);
  Commands commands(transport);
  LiveRecordingOptions options;
  options.live.settle = 1.0;
  options.check_setup = [](const RecordingSetup&) { return Result<void>(); };
  options.waiting = [](const std::string&) {};
  auto reader = open_live_recording(transport, commands, options);
  ASSERT_TRUE(reader) << reader.error().message;
  ASSERT_TRUE(*reader);
  transport.play_all();
  const auto deliveries = test::read_all(**reader);
  ASSERT_TRUE(deliveries);
  EXPECT_GT(test::scans_of(*deliveries).size(), 40U);
  EXPECT_FALSE((*reader)->counts().contains("lidar_messages_missing"));
}

}  // namespace
}  // namespace aims
