// SPDX-License-Identifier: BSD-3-Clause
#include "live/dds/playback.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <map>
#include <optional>
#include <thread>
#include <utility>

#include "core/stopwatch.hpp"
#include "recordings/bag/message_sink.hpp"
#include "recordings/messages/ros2_definition.hpp"
#include "recordings/source/conversion.hpp"

namespace aims {
namespace {

using Clock = std::chrono::steady_clock;

constexpr auto kPatience = std::chrono::milliseconds(50);  ///< between looks at the network
constexpr double kDelay = 1.0;                          ///< for subscribers to find the topics [s]
constexpr double kReportPeriod = 5.0;                   ///< [s]
constexpr Time kEndOfTime = (Time{1} << 31) * kSecond;  ///< of DDS, in 2038: it drops what is later
constexpr double kLastWait = 5.0;        ///< for subscribers to take the last messages [s]
constexpr std::size_t kAhead = 500'000;  ///< of the slowest subscriber [bytes]
constexpr double kAnswer = 1.0;          ///< for a subscriber to acknowledge them [s]

/// Sends each message when it is due.
class PacedSink final : public MessageSink {
 public:
  PacedSink(DdsTransport& transport, double rate, PlaybackOutcome& outcome)
      : transport_(transport), rate_(rate), outcome_(outcome) {}

  Serialization serialization() const override { return Serialization::kCdr; }

  std::uint32_t add_connection(const std::string& topic, const MessageType& type,
                               bool latching) override {
    const auto [place, added] = publishers_.try_emplace({topic, type.name}, 0);
    if (added) {
      place->second = static_cast<std::uint32_t>(
          transport_.advertise({topic, type.name, {}, {}, latching, true}));
    }
    return place->second;
  }

  Result<void> write(std::uint32_t publisher, Time record_time,
                     std::span<const std::byte> data) override {
    wait_until(record_time);
    if (!transport_.running()) return {};
    if (record_time < 0 || record_time >= kEndOfTime) {
      if (outcome_.unsendable++ == 0) outcome_.unsendable_time = record_time;
    } else if (!transport_.publish_at(publisher, record_time, data.data(), data.size())) {
      ++outcome_.blocked;
    }
    if (rate_ > 1.0) keep_in_step(data.size());
    return {};
  }

  Result<void> close() override {
    outcome_.unanswered = transport_.wait_for_subscribers(kLastWait);
    return {};
  }

  /// A topic without a subscriber; empty: each has one.
  std::string unheard() const {
    for (const auto& [topic, publisher] : publishers_) {
      if (transport_.subscribers(publisher) == 0) return topic.first;
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
  PlaybackOutcome& outcome_;
  std::map<std::pair<std::string, std::string>, std::uint32_t> publishers_;
  std::optional<Time> first_;
  Clock::time_point start_;
  std::size_t ahead_ = 0;  ///< sent since all subscribers had everything [bytes]
  bool answered_ = true;   ///< by all subscribers, when last asked
};

bool wanted(const std::string& topic, const std::vector<std::string>& topics) {
  return topics.empty() || std::ranges::find(topics, topic) != topics.end();
}

/// Announces every topic before the first message, so that subscribers find them in time; returns
/// those that can be played.
std::vector<std::string> announce(const MessageSource& recording, PacedSink& sink,
                                  const PlaybackOptions& options, PlaybackOutcome& outcome) {
  std::vector<std::string> playable;
  for (const BagConnection& connection : recording.connections()) {
    if (!wanted(connection.topic, options.topics)) continue;
    Result<MessageType> type =
        MessageType{connection.type, connection.md5, connection.definition, connection.format};
    if (connection.format.serialization == Serialization::kRos1) type = ros2_type(*type);
    if (connection.format.serialization == Serialization::kOther) {
      type = failure("neither ROS 1 nor CDR");
    }
    if (!type) {
      outcome.skipped.push_back(fmt::format("{}: {}", connection.topic, type.error().message));
      continue;
    }
    sink.add_connection(connection.topic, *type, connection.latching);
    playable.push_back(connection.topic);
  }
  return playable;
}

/// Until each topic has a subscriber, else for `kDelay`.
void wait_to_start(const DdsTransport& transport, const PacedSink& sink,
                   const PlaybackOptions& options) {
  const Stopwatch since_start;
  Stopwatch since_report;
  while (transport.running()) {
    const std::string unheard = options.wait ? sink.unheard() : "";
    if (unheard.empty() && (options.wait || since_start.seconds() > kDelay)) return;
    if (since_report.seconds() > kReportPeriod) {
      since_report = Stopwatch();
      options.waiting(fmt::format("no subscriber of {} yet", unheard));
    }
    std::this_thread::sleep_for(kPatience);
  }
}

}  // namespace

Result<PlaybackOutcome> play(MessageSource& recording, DdsTransport& transport,
                             const PlaybackOptions& options) {
  PlaybackOutcome outcome;
  PacedSink sink(transport, options.rate, outcome);
  const std::vector<std::string> topics = announce(recording, sink, options, outcome);
  if (topics.empty()) return failure(recording.name() + ": no topic to play");
  recording.select(topics);
  wait_to_start(transport, sink, options);
  const auto done = convert_messages(recording, sink, [&](Time) { return transport.running(); });
  if (!done) return tl::unexpected(done.error());
  outcome.topics = done->topics;
  outcome.messages = done->messages;
  outcome.complete = done->complete && transport.running();
  return outcome;
}

}  // namespace aims
