// SPDX-License-Identifier: BSD-3-Clause
// The record of a live estimate is read as that one read it.
#include <gtest/gtest.h>

#include <algorithm>
#include <deque>
#include <filesystem>
#include <memory>
#include <optional>
#include <utility>
#include <variant>
#include <vector>

#include "live/live_source.hpp"
#include "live/recorder.hpp"
#include "recordings/source/conversion.hpp"
#include "recordings/source/recording_file.hpp"
#include "recordings/stream/recording_reader.hpp"
#include "recordings/stream/recording_writer.hpp"
#include "tests/recordings/stream/recorded_deliveries.hpp"
#include "tests/recordings/stream/recorded_trot.hpp"
#include "tests/support/kinematic_world.hpp"
#include "tests/support/temporary_folder.hpp"

namespace aims {
namespace {

constexpr Duration kSettle = kSecond;

/// A walk whose LiDAR sets its clock right after a second: before, clouds come 25 ms after their
/// stamp, as clouds do that are stamped at their end.
void record_walk(const std::filesystem::path& file) {
  test::KinematicWorld world(test::short_walk());
  auto writer = RecordingWriter::create(file, world.rig(), "seed: 1");
  ASSERT_TRUE(writer) << writer.error().message;
  std::vector<Delivery> deliveries = test::record(world);
  const Time first = deliveries.front().arrival;
  for (Delivery& each : deliveries) {
    const bool is_scan = std::holds_alternative<LidarScanPtr>(each.measurement);
    if (is_scan && each.arrival < first + kSettle) each.arrival -= 80 * kMillisecond;
  }
  std::ranges::stable_sort(deliveries, {}, &Delivery::arrival);
  for (const Delivery& each : deliveries) {
    const Time arrival = each.arrival;
    if (const auto* imu = std::get_if<ImuSample>(&each.measurement)) {
      ASSERT_TRUE(writer->write_imu(ImuOutput::kMain, arrival, *imu));
    } else if (const auto* legs = std::get_if<LegOdometrySample>(&each.measurement)) {
      ASSERT_TRUE(writer->write_legs(arrival, *legs));
    } else {
      ASSERT_TRUE(writer->write_scan(arrival, *std::get<LidarScanPtr>(each.measurement)));
    }
  }
  ASSERT_TRUE(writer->close());
}

/// The recording as ROS 2 has it.
void convert(const std::filesystem::path& from, const std::filesystem::path& to) {
  auto source = open_recording(from);
  ASSERT_TRUE(source) << source.error().message;
  auto sink = create_recording(to, RecordingFormat::kMcap);
  ASSERT_TRUE(sink) << sink.error().message;
  ASSERT_TRUE(convert_messages(**source, **sink, [](Time) { return true; }));
}

/// What comes over the network: the messages of a recording.
LiveMessages messages_of(const std::filesystem::path& file) {
  LiveMessages messages;
  auto source = open_recording(file);
  EXPECT_TRUE(source) << source.error().message;
  std::vector<std::shared_ptr<const BagConnection>> connections;
  for (const BagConnection& each : (*source)->connections()) {
    connections.push_back(std::make_shared<BagConnection>(each));
  }
  for (auto next = (*source)->next(); next && *next; next = (*source)->next()) {
    messages.push_back({connections[(*next)->connection->id],
                        (*next)->record_time,
                        {(*next)->data.begin(), (*next)->data.end()}});
  }
  return messages;
}

/// What a live estimate reads of these messages; its record is `record`.
std::vector<Delivery> read_live(LiveMessages coming, const std::filesystem::path& record,
                                const RecordingConfig& config) {
  auto gathered = std::make_shared<LiveMessages>();
  const Time settled = coming.at(1).arrival + kSettle;  // the first one may be a fixed transform
  while (!coming.empty() && coming.front().arrival < settled) {
    gathered->push_back(std::move(coming.front()));
    coming.pop_front();
  }
  auto source = std::make_unique<LiveSource>(gathered, [&]() -> std::optional<LiveMessage> {
    if (coming.empty()) return std::nullopt;
    LiveMessage next = std::move(coming.front());
    coming.pop_front();
    return next;
  });
  LiveSource& live = *source;
  auto reader = open_live(std::move(source), config);
  EXPECT_TRUE(reader) << reader.error().message;
  if (!reader) return {};
  auto recorder = Recorder::create(record, record.extension() == ".mcap" ? kRos2Format : kRos1Format);
  EXPECT_TRUE(recorder);
  if (!recorder) return {};
  live.go_live([&](const BagMessage& message) { recorder->add(message); });
  auto deliveries = test::read_all(*reader);
  EXPECT_TRUE(deliveries);
  EXPECT_TRUE(recorder->close());
  return std::move(*deliveries);
}

class LiveReplay : public testing::TestWithParam<const char*> {
 protected:
  std::vector<Delivery> read(const RecordingConfig& config) const {
    auto reader = RecordingReader::open(record_, config);
    EXPECT_TRUE(reader) << reader.error().message;
    auto deliveries = test::read_all(*reader);
    EXPECT_TRUE(deliveries);
    return std::move(*deliveries);
  }

  /// What a live estimate reads of a walk; its record is `record_`.
  std::vector<Delivery> read_live() const {
    const std::filesystem::path walk = folder_.path() / "walk.bag";
    const std::filesystem::path walk_of_ros2 = folder_.path() / "walk.mcap";
    const bool cdr = record_.extension() == ".mcap";
    record_walk(walk);
    if (cdr) convert(walk, walk_of_ros2);
    return aims::read_live(messages_of(cdr ? walk_of_ros2 : walk), record_, {});
  }

  TemporaryFolder folder_;
  std::filesystem::path record_ = folder_.path() / (std::string("live") + GetParam());
};

TEST_P(LiveReplay, DecidesFromWhatTheLiveEstimateHad) {
  const std::vector<Delivery> live = read_live();
  ASSERT_GT(live.size(), 1000U);
  test::expect_same_deliveries(live, read({}));
  // Of the whole recording most clouds come after their scan.
  RecordingConfig anew;
  anew.as_live = false;
  EXPECT_NE(test::scans_of(live).front()->end, test::scans_of(read(anew)).front()->end);
}

INSTANTIATE_TEST_SUITE_P(Formats, LiveReplay, testing::Values(".mcap", ".bag"));

class LiveLegs : public test::RecordedTrot {};

TEST_F(LiveLegs, InMessagesOfTheirOwnAreJoinedAsInARecording) {
  RecordingConfig config;
  config.topics.lidar = "none";
  for (const bool on_change : {false, true}) {
    const auto record = folder_.path() / (on_change ? "on_change.bag" : "always.bag");
    const auto file = write({.forces = false,
                             .single = "/{}/joint_states",
                             .on_change = on_change,
                             .single_contacts = "/{}/contact"});
    const std::vector<Delivery> live = read_live(messages_of(file), record, config);
    EXPECT_GT(test::legs_of(live).size(), 390U);
    test::expect_same_deliveries(live, test::read_recording(record, config).deliveries);
    test::expect_same_deliveries(live, test::read_recording(file, config).deliveries);
  }
}

}  // namespace
}  // namespace aims
