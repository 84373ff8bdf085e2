// SPDX-License-Identifier: BSD-3-Clause
#include "live/live_recording.hpp"

#include <gtest/gtest.h>

#include <deque>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "recordings/source/recording_file.hpp"
#include "recordings/stream/recording_writer.hpp"
#include "tests/recordings/stream/recorded_deliveries.hpp"
#include "tests/support/kinematic_world.hpp"
#include "tests/support/temporary_folder.hpp"

namespace aims {
namespace {

/// Plays a recording: a second of it each time that the topics are asked for.
class PlayedTransport final : public Transport {
 public:
  explicit PlayedTransport(const std::filesystem::path& file) {
    auto source = open_recording(file);
    EXPECT_TRUE(source) << source.error().message;
    std::vector<std::shared_ptr<const BagConnection>> connections;
    for (const BagConnection& each : (*source)->connections()) {
      connections.push_back(std::make_shared<BagConnection>(each));
      topics_[each.topic] = each.type;
    }
    for (auto next = (*source)->next(); next && *next; next = (*source)->next()) {
      coming_.push_back({connections[(*next)->connection->id],
                         (*next)->record_time,
                         {(*next)->data.begin(), (*next)->data.end()}});
    }
    horizon_ = coming_.front().arrival;
  }

  MessageFormat format() const override { return kRos1Format; }
  bool running() const override { return !coming_.empty(); }
  bool preceded(const std::string&) override { return false; }
  std::map<std::string, std::string> topics() override {
    horizon_ += kSecond;
    return topics_;
  }
  std::string resolved(const std::string& topic) const override { return topic; }
  void subscribe(const std::string&, const std::string&) override {}
  void unsubscribe(const std::string&) override {}
  std::optional<LiveMessage> wait(double) override {
    if (coming_.empty() || (coming_.front().arrival > horizon_ && !at_once_)) return std::nullopt;
    LiveMessage message = std::move(coming_.front());
    coming_.pop_front();
    return message;
  }
  std::size_t advertise(const std::string&, const MessageType&, bool) override { return 0; }
  bool heard(std::size_t) const override { return false; }
  void publish(std::size_t, std::span<const std::byte>) override {}

  /// Gives the rest without being asked.
  void play_all() { at_once_ = true; }

 private:
  std::map<std::string, std::string> topics_;
  std::deque<LiveMessage> coming_;
  Time horizon_ = 0;
  bool at_once_ = false;
};

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
  PlayedTransport transport(file);
  Commands commands(transport);
  LiveRecordingOptions options;
  options.settle = kSecond;
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
