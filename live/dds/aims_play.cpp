// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "core/stopwatch.hpp"
#include "core/text.hpp"
#include "live/dds/dds_options.hpp"
#include "live/program.hpp"
#include "recordings/messages/ros2_definition.hpp"
#include "recordings/source/conversion.hpp"
#include "recordings/source/decided_start.hpp"
#include "recordings/source/recording_file.hpp"

namespace aims {
namespace {

using Clock = std::chrono::steady_clock;

constexpr auto kPatience = std::chrono::milliseconds(50);  ///< between looks at the network
constexpr double kMaxBlocking = 10.0;                   ///< a player waits for its subscribers [s]
constexpr double kDelay = 1.0;                          ///< for subscribers to find the topics [s]
constexpr double kReportPeriod = 5.0;                   ///< [s]
constexpr Time kEndOfTime = (Time{1} << 31) * kSecond;  ///< of DDS, in 2038: it drops what is later
constexpr double kLastWait = 5.0;        ///< for subscribers to take the last messages [s]
constexpr std::size_t kAhead = 500'000;  ///< of the slowest subscriber [bytes]
constexpr double kAnswer = 1.0;          ///< for a subscriber to acknowledge them [s]

void warn(const std::string& message) { fmt::print(stderr, "aims_play: warning: {}\n", message); }

struct PlayOptions {
  std::vector<std::string> files;
  bool recover = false;             ///< of a damaged recording, what is intact
  double rate = 1.0;                ///< of the recording's pace
  std::vector<std::string> topics;  ///< empty: all
  std::size_t wait = 0;  ///< for so many subscribers of each topic before it starts; 0: a second
};

/// Sends each message when it is due; the time of sending is the record time.
class PacedSink final : public MessageSink {
 public:
  PacedSink(DdsTransport& transport, double rate) : transport_(transport), rate_(rate) {}

  Serialization serialization() const override { return Serialization::kCdr; }

  std::uint32_t add_connection(const std::string& topic, const MessageType& type,
                               bool latching) override {
    const auto [place, added] = publishers_.try_emplace({topic, type.name}, 0);
    if (added) {
      place->second = static_cast<std::uint32_t>(transport_.advertise(topic, type, latching));
    }
    return place->second;
  }

  Result<void> write(std::uint32_t publisher, Time record_time,
                     std::span<const std::byte> data) override {
    wait_until(record_time);
    if (!transport_.running()) return {};
    if (record_time < 0 || record_time >= kEndOfTime) {
      if (unsendable_++ == 0) unsendable_time_ = record_time;
    } else if (!transport_.publish_at(publisher, record_time, data)) {
      ++blocked_;
    }
    if (rate_ > 1.0) keep_in_step(data.size());
    return {};
  }

  /// Waits for the subscribers; says what was not sent, or not acknowledged.
  Result<void> close() override {
    const std::size_t unanswered = transport_.wait_for_subscribers(kLastWait);
    if (blocked_ > 0) {
      warn(
          fmt::format("{} messages were not sent: a subscriber is too slow, or they are shorter "
                      "than the header of CDR",
                      blocked_));
    }
    if (unsendable_ > 0) {
      warn(
          fmt::format("{} messages were not sent: DDS holds times from 1970 to 2038, the first "
                      "was recorded at {} s",
                      unsendable_, stamp_text(unsendable_time_)));
    }
    if (unanswered > 0) {
      warn(fmt::format("{} topics have a subscriber that did not acknowledge the last messages",
                       unanswered));
    }
    return {};
  }

  /// A topic with fewer subscribers; empty: each has so many.
  std::string unheard(std::size_t subscribers) const {
    for (const auto& [topic, publisher] : publishers_) {
      if (transport_.subscribers(publisher) < subscribers) return topic.first;
    }
    return {};
  }

 private:
  void wait_until(Time record_time) {
    if (!first_) {
      first_ = record_time;
      start_ = Clock::now();
    }
    const std::chrono::duration<double> due(to_seconds(record_time - *first_) / rate_);
    const auto then = start_ + std::chrono::duration_cast<Clock::duration>(due);
    while (transport_.running() && Clock::now() < then) {
      std::this_thread::sleep_until(std::min(then, Clock::now() + kPatience));
    }
  }

  /// Faster than sensors send, it waits until all subscribers have what was sent. One that does not
  /// answer, as after a kill -9, is waited for once: DDS gives it up after 10 s, meanwhile it keeps
  /// the messages.
  void keep_in_step(std::size_t size) {
    ahead_ += size;
    if (ahead_ < kAhead) return;
    ahead_ = 0;
    answered_ = transport_.wait_for_subscribers(answered_ ? kAnswer : 0.0) == 0;
  }

  DdsTransport& transport_;
  double rate_;
  std::map<std::pair<std::string, std::string>, std::uint32_t> publishers_;
  std::optional<Time> first_;
  Clock::time_point start_;
  std::size_t ahead_ = 0;    ///< sent since all subscribers had everything [bytes]
  bool answered_ = true;     ///< by all subscribers, when last asked
  std::size_t blocked_ = 0;  ///< messages
  std::size_t unsendable_ = 0;
  Time unsendable_time_ = 0;  ///< the first of these
};

/// The type under which ROS 2 has the topic.
Result<MessageType> playable_type(const BagConnection& connection) {
  const MessageType type{connection.type, connection.md5, connection.definition, connection.format};
  if (type.format.serialization == Serialization::kOther) return failure("neither ROS 1 nor CDR");
  return type.format.serialization == Serialization::kRos1 ? ros2_type(type) : type;
}

/// Announces every topic before the first message, so that subscribers find them in time; selects
/// those that can be played. Error when there are none.
Result<void> announce(MessageSource& recording, PacedSink& sink,
                      const std::vector<std::string>& topics) {
  std::vector<std::string> playable;
  for (const BagConnection& each : recording.connections()) {
    if (!topics.empty() && std::ranges::find(topics, each.topic) == topics.end()) continue;
    // What marks the record of a live estimate: nobody would subscribe.
    if (is_mark(each.topic)) continue;
    const auto type = playable_type(each);
    if (!type) {
      warn(fmt::format("not played: {}: {}", each.topic, type.error().message));
      continue;
    }
    sink.add_connection(each.topic, *type, each.latching);
    playable.push_back(each.topic);
  }
  if (playable.empty()) return failure(recording.name() + ": no topic to play");
  recording.select(playable);
  return {};
}

/// Until each topic has so many subscribers, for none `kDelay`.
void wait_to_start(const DdsTransport& transport, const PacedSink& sink, std::size_t subscribers) {
  const Stopwatch since_start;
  Stopwatch since_report;
  while (transport.running()) {
    const std::string unheard = sink.unheard(subscribers);
    if (unheard.empty() && (subscribers > 0 || since_start.seconds() > kDelay)) return;
    if (since_report.seconds() > kReportPeriod) {
      since_report = Stopwatch();
      fmt::print(stderr, "aims_play: waiting: {} has not {} yet\n", unheard,
                 subscribers == 1 ? "a subscriber" : fmt::format("{} subscribers", subscribers));
    }
    std::this_thread::sleep_for(kPatience);
  }
}

Result<void> play(const PlayOptions& options, const DdsOptions& dds) {
  const std::vector<std::filesystem::path> with(options.files.begin() + 1, options.files.end());
  const auto recording =
      open_recording(options.files.front(), {.recover = options.recover, .with = with});
  if (!recording) return tl::unexpected(recording.error());
  const auto transport = DdsTransport::connect(dds);
  if (!transport) return tl::unexpected(transport.error());
  PacedSink sink(**transport, options.rate);
  if (auto ok = announce(**recording, sink, options.topics); !ok) return ok;
  wait_to_start(**transport, sink, options.wait);
  const auto done =
      convert_messages(**recording, sink, [&](Time) { return (*transport)->running(); });
  for (const std::string& problem : (*transport)->take_problems()) warn(problem);
  if (!done) return tl::unexpected(done.error());
  const bool complete = done->complete && (*transport)->running();
  fmt::print("{} messages of {} topics on domain {}{}\n", done->messages, done->topics, dds.domain,
             complete ? "" : ", interrupted");
  return {};
}

}  // namespace
}  // namespace aims

int main(int argc, char** argv) {
  using namespace aims;
  CLI::App app("Publishes a recording on DDS at its own pace, as ROS 2 nodes do.", "aims_play");
  app.footer(
      "The time of sending is the record time. CYCLONEDDS_URI chooses the interfaces.\n"
      "Exit codes: 0 ok, also when interrupted; 2 bad usage, recording or network.");
  PlayOptions options;
  DdsOptions dds{.node = "aims_play", .keep_all = true, .max_blocking = kMaxBlocking};
  app.add_option("recording", options.files,
                 "Recording, simulated or of a robot: files or folders, merged by record time")
      ->required();
  app.add_flag("--recover", options.recover, "Read the intact part of a damaged recording");
  app.add_option("--rate", options.rate, "Of the recording's pace (1)")
      ->check(CLI::Range(0.01, 1000.0));
  add_domain_option(app, dds);
  app.add_option("--topics", options.topics, "Only these, e.g. /imu/data,/lidar/points")
      ->delimiter(',');
  app.add_flag("--wait{1}", options.wait,
               "Start once each topic has a subscriber, with --wait=2 two; else after a second")
      ->check(CLI::Range(1, 1000));
  return run_program(app, {argv + 1, argv + argc}, [&] { return play(options, dds); });
}
