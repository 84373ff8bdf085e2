// SPDX-License-Identifier: BSD-3-Clause
#include "live/live_session.hpp"

#include <gtest/gtest.h>

#include <chrono>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <thread>
#include <utility>

#include "recordings/messages/message_encoding.hpp"
#include "recordings/messages/message_types.hpp"
#include "recordings/stream/recording_writer.hpp"
#include "tests/live/played_transport.hpp"
#include "tests/support/kinematic_world.hpp"
#include "tests/support/temporary_folder.hpp"

namespace aims {
namespace {

/// A walk at five times its pace. After a third of it, a reset is sent; while topics are gathered
/// again, a second node publishes the IMU and ends. Three messages are lost before and two behind.
class Network final : public test::PlayedTransport {
 public:
  explicit Network(const std::filesystem::path& file)
      : PlayedTransport(file), all_(coming_.size()) {}

  std::map<std::string, std::string> topics() override {
    if (restarted_ && !std::exchange(was_doubled_, true)) doubled_["/imu/data"] = 2;
    return topics_;
  }

  std::optional<LiveMessage> wait(double seconds) override {
    if (coming_.size() < 2 * all_ / 3 && !std::exchange(restarted_, true)) {
      return command("reset");
    }
    auto message = PlayedTransport::wait(seconds);
    if (!message) {
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
      horizon_ += 5 * kMillisecond;
    }
    return message;
  }

  std::map<std::string, std::size_t> take_doubled() override { return std::exchange(doubled_, {}); }

 private:
  std::size_t lost() const override { return coming_.size() < all_ / 3 ? 5 : restarted_ ? 3 : 0; }

  LiveMessage command(const std::string& text) {
    BagConnection connection;
    connection.topic = "~command";
    connection.type = string_type().name;
    connection.definition = string_type().definition;
    const MessageBytes message = string_message(text);
    const auto bytes = message.view();
    return {std::make_shared<BagConnection>(std::move(connection)),
            coming_.front().arrival,
            {bytes.begin(), bytes.end()}};
  }

  std::size_t all_;
  bool restarted_ = false;
  bool was_doubled_ = false;
  std::map<std::string, std::size_t> doubled_;
};

void record_walk(const std::filesystem::path& file) {
  test::KinematicWorld world(test::short_walk());
  auto writer = RecordingWriter::create(file, world.rig(), "seed: 1");
  ASSERT_TRUE(writer) << writer.error().message;
  for (const Delivery& each : test::record(world)) {
    if (const auto* imu = std::get_if<ImuSample>(&each.measurement)) {
      ASSERT_TRUE(writer->write_imu(ImuOutput::kMain, each.arrival, *imu));
    } else if (const auto* scan = std::get_if<LidarScanPtr>(&each.measurement)) {
      ASSERT_TRUE(writer->write_scan(each.arrival, **scan));
    }
  }
  ASSERT_TRUE(writer->close());
}

std::string content(const std::filesystem::path& file) {
  std::ifstream in(file);
  return {std::istreambuf_iterator<char>(in), {}};
}

TEST(LiveSession, EachPartHasItsOwnCountsAndNamesWhatWasSeenBetween) {
  const TemporaryFolder folder;
  const auto file = folder.path() / "walk.bag";
  record_walk(file);
  Network network(file);
  LiveOptions options;
  options.estimator = "lio";
  options.settle = 0.5;
  options.out = (folder.path() / "out").string();
  testing::internal::CaptureStdout();
  const auto done = run_live(network, options);
  const std::string said = testing::internal::GetCapturedStdout();
  ASSERT_TRUE(done) << done.error().message;
  const std::size_t second = said.find("starting anew: reset");
  ASSERT_NE(second, std::string::npos) << said;
  EXPECT_NE(said.find("note: 3 messages lost by the network\n"), std::string::npos) << said;
  EXPECT_NE(said.find("note: 2 messages lost by the network\n", second), std::string::npos) << said;
  EXPECT_NE(said.find("note: 5 messages lost by the network, in all 2 parts\n"), std::string::npos);
  const std::string reason = "/imu/data has 2 publishers";
  const std::string before = content(folder.path() / "out" / "lio.health.csv");
  EXPECT_NE(before.find("stamp_s"), std::string::npos) << before;
  EXPECT_EQ(before.find(reason), std::string::npos);
  const std::string rows = content(folder.path() / "out" / "part-2" / "lio.health.csv");
  EXPECT_NE(rows.find(reason), std::string::npos) << rows;
}

}  // namespace
}  // namespace aims
