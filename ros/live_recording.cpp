// SPDX-License-Identifier: BSD-3-Clause
#include "ros/live_recording.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <memory>
#include <set>
#include <string_view>
#include <utility>
#include <vector>

#include "core/stopwatch.hpp"
#include "ros/live_source.hpp"

namespace aims {
namespace {

constexpr double kPoll = 0.2;             ///< between looks for new topics [s]
constexpr double kComplainEvery = 5.0;    ///< [s]
constexpr Duration kKept = 10 * kSecond;  ///< of what is gathered, however long it takes

/// Types that hold nothing to estimate from, and may be heavy.
constexpr std::array<std::string_view, 6> kIgnoredTypes = {
    "sensor_msgs/Image", "sensor_msgs/CompressedImage", "stereo_msgs/DisparityImage",
    "rosgraph_msgs/Log", "rosgraph_msgs/Clock",         "visualization_msgs/MarkerArray"};

/// Collects what comes on all topics, at most `kKept` of it, and latched messages for ever.
class Gathering {
 public:
  explicit Gathering(RosTransport& transport)
      : transport_(transport), own_(transport.resolved("~")) {}

  /// Takes messages for `kPoll`.
  void collect() {
    for (const auto& [topic, type] : transport_.topics()) {
      if (std::ranges::find(kIgnoredTypes, type) != kIgnoredTypes.end()) continue;
      if (!topic.starts_with(own_) && subscribed_.insert(topic).second) {
        transport_.subscribe(topic);
      }
    }
    const Stopwatch timer;
    while (timer.seconds() < kPoll) {
      // Time 0: a simulated clock that has not begun.
      if (auto message = transport_.wait(kPoll); message && message->arrival > 0) {
        messages_->push_back(std::move(*message));
      }
      if (!transport_.running()) return;
    }
    trim();
  }

  Duration span() const {
    return messages_->empty() ? 0 : messages_->back().arrival - messages_->front().arrival;
  }

  const std::shared_ptr<RosMessages>& messages() const { return messages_; }
  const std::set<std::string>& subscribed() const { return subscribed_; }

 private:
  void trim() {
    if (span() <= kKept) return;
    const Time oldest = messages_->back().arrival - kKept;
    std::erase_if(*messages_, [&](const RosMessage& message) {
      return message.arrival < oldest && !message.connection->latching;
    });
  }

  RosTransport& transport_;
  std::string own_;
  std::shared_ptr<RosMessages> messages_ = std::make_shared<RosMessages>();
  std::set<std::string> subscribed_;
};

Result<RecordingReader> try_open(RosTransport& transport, const Gathering& gathering,
                                 const RecordingConfig& config, const EnoughFound& enough) {
  auto wait = [&transport]() -> std::optional<RosMessage> {
    while (transport.running()) {
      if (auto message = transport.wait(kPoll)) return message;
    }
    return std::nullopt;
  };
  auto source = std::make_unique<LiveSource>(gathering.messages(), wait);
  LiveSource& live = *source;
  auto reader = RecordingReader::open(std::move(source), config);
  if (!reader) return reader;
  if (auto ok = enough(reader->setup()); !ok) return tl::unexpected(ok.error());
  for (const std::string& topic : gathering.subscribed()) {
    if (!live.selects(topic)) transport.unsubscribe(topic);
  }
  live.go_live();
  return reader;
}

}  // namespace

Result<RecordingReader> open_live_recording(
    RosTransport& transport, const RecordingConfig& config, const LiveRecordingOptions& options,
    const EnoughFound& enough, const std::function<void(const std::string&)>& waiting) {
  Gathering gathering(transport);
  const Stopwatch since_start;
  Stopwatch since_complaint;
  std::string missing = "no messages yet";
  while (transport.running()) {
    gathering.collect();
    if (gathering.span() >= options.settle) {
      auto reader = try_open(transport, gathering, config, enough);
      if (reader) return reader;
      missing = reader.error().message;
    } else if (gathering.span() > 0) {
      missing = fmt::format("{:.1f} s of messages so far", to_seconds(gathering.span()));
    }
    if (options.patience > 0.0 && since_start.seconds() > options.patience) {
      return failure(fmt::format("gave up after {:g} s: {}", options.patience, missing));
    }
    if (since_complaint.seconds() < kComplainEvery) continue;
    waiting(missing);
    since_complaint = Stopwatch();
  }
  return failure(fmt::format("ended before it began: {}", missing));
}

}  // namespace aims
