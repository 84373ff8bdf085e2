// SPDX-License-Identifier: BSD-3-Clause
#include "live/live_recording.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <memory>
#include <set>
#include <string_view>
#include <utility>

#include "core/stopwatch.hpp"
#include "recordings/messages/message_values.hpp"
#include "recordings/source/decided_start.hpp"
#include "recordings/topics/recording_topics.hpp"

namespace aims {
namespace {

constexpr double kPoll = 0.2;          ///< between queries for new topics [s]
constexpr double kReportPeriod = 5.0;  ///< [s]
constexpr double kLookPeriod = 1.0;    ///< for fixed transforms, while it estimates [s]
constexpr Duration kCatchUp = 2 * kSecond;
constexpr Duration kMaxGathered = 10 * kSecond;  ///< of messages, however long it takes
constexpr std::size_t kMostTransforms = 1000;    ///< messages

/// Types that estimators do not use: large ones, and what every node of ROS 2 publishes.
constexpr std::array<std::string_view, 8> kIgnoredTypes = {
    "sensor_msgs/Image",  "sensor_msgs/CompressedImage",  "stereo_msgs/DisparityImage",
    "rosgraph_msgs/Log",  "rosgraph_msgs/Clock",          "visualization_msgs/MarkerArray",
    "rcl_interfaces/Log", "rcl_interfaces/ParameterEvent"};

/// Whether a live estimate publishes that topic: another one, which runs beside this one.
bool is_estimated(const std::string& topic, const std::map<std::string, std::string>& topics) {
  constexpr std::array<std::string_view, 4> kPublished = {"odometry", "odometry_fast", "cloud",
                                                          "map"};
  const std::size_t name = topic.rfind('/') + 1;
  return std::ranges::find(kPublished, topic.substr(name)) != kPublished.end() &&
         topics.contains(topic.substr(0, name) + "odometry_fast");
}

/// The frames that a message of /tf_static places; empty: it is none.
std::string placed_frames(const LiveMessage& message) {
  std::string frames;
  const BagConnection& from = *message.connection;
  if (from.topic != kStaticTransformsTopic) return frames;
  const auto decoder = MessageDecoder::create(from.type, from.definition, from.format);
  if (!decoder) return frames;
  const auto view = decoder->decode(message.data);
  if (!view) return frames;
  for (const FrameTransform& each : transforms_in(*view)) {
    frames += fmt::format("{} {}\n", each.parent, each.child);
  }
  return frames;
}

/// Keeps a message of /tf_static, instead of the last one of its frames.
void keep(const LiveMessage& message, LiveTransforms* transforms) {
  if (transforms == nullptr || transforms->size() >= kMostTransforms) return;
  const std::string frames = placed_frames(message);
  if (!frames.empty()) transforms->insert_or_assign(frames, message);
}

/// Fixed transforms whose publisher came late serve the next estimate.
void subscribe_to_late_transforms(Transport& transport) {
  const auto topics = transport.topics();
  const auto found = topics.find(std::string(kStaticTransformsTopic));
  if (found != topics.end()) transport.subscribe(found->first, found->second);
}

/// Collects the messages of all topics of the last `kMaxGathered`, and all latched and fixed ones,
/// until they can be read.
class Gathering {
 public:
  Gathering(Transport& transport, Commands& commands, const LiveRecordingOptions& options)
      : transport_(transport),
        commands_(commands),
        options_(options),
        settle_(from_seconds(options.live.settle)) {
    if (options.recorder != nullptr) {
      observer_ = [recorder = options.recorder](const BagMessage& message) {
        recorder->add(message);
      };
    }
    if (options.transforms != nullptr) before_ = *options.transforms;
    // To receive latched messages again, where another estimate went before.
    for (const auto& [topic, type] : transport.topics()) {
      if (!is_command(topic)) transport.unsubscribe(topic);
    }
  }

  /// The reader once it can be opened; none when the node ends before. Error after the timeout.
  Result<std::optional<RecordingReader>> wait_to_open() {
    const Stopwatch since_start;
    Stopwatch since_report;
    std::string missing = "no messages yet";
    while (transport_.running()) {
      collect();
      auto reader = try_open();
      if (reader) return std::move(*reader);
      missing = reader.error().message;
      if (options_.live.patience > 0.0 && since_start.seconds() > options_.live.patience) {
        return failure(fmt::format("timeout after {:g} s: {}", options_.live.patience, missing));
      }
      if (since_report.seconds() < kReportPeriod) continue;
      options_.waiting(missing);
      since_report = Stopwatch();
    }
    options_.waiting(missing + "; ended before the estimate could start");
    return std::nullopt;
  }

  /// Shows the observer what was heard, which is to tell why it did not start.
  void show() const {
    if (observer_) LiveSource(messages_, {}).show(observer_);
  }

 private:
  /// Collects messages for `kPoll`.
  void collect() {
    const auto topics = transport_.topics();
    for (const auto& [topic, type] : topics) {
      if (std::ranges::find(kIgnoredTypes, type) != kIgnoredTypes.end()) continue;
      if (is_estimated(topic, topics) || is_command(topic) || is_mark(topic)) continue;
      if (subscribed_.insert(topic).second) transport_.subscribe(topic, type);
    }
    const Stopwatch timer;
    while (timer.seconds() < kPoll) {
      // Time 0: a simulated clock that has not started.
      if (auto message = commands_.wait(kPoll); message && message->arrival > 0) {
        keep(*message, options_.transforms);
        if (!messages_->empty() && message->arrival < messages_->back().arrival - kSecond) {
          begin_again(message->arrival);
        }
        messages_->push_back(std::move(*message));
      }
      if (!transport_.running()) return;
    }
    const Duration kept = std::max(kMaxGathered, settle_ + kSecond);
    if (span() > kept) forget(messages_->back().arrival - kept);
  }

  /// Forgets what came before `oldest`, which the observer sees; but not what is sent once.
  void forget(Time oldest) {
    LiveMessages kept, forgotten;
    for (LiveMessage& message : *messages_) {
      const bool old = message.arrival < oldest && !lasts(message);
      message.arrival = old ? message.arrival : std::max(message.arrival, oldest);
      (old ? forgotten : kept).push_back(std::move(message));
    }
    *messages_ = std::move(kept);
    if (!observer_ || forgotten.empty()) return;
    forgot_ = true;
    LiveSource(std::make_shared<LiveMessages>(std::move(forgotten)), {}).show(observer_);
  }

  /// The clock of arrivals was set back: what came before lies in its future, as does what the
  /// observer has seen of it.
  void begin_again(Time now) {
    if (std::exchange(forgot_, false)) options_.recorder->begin_again();
    std::erase_if(*messages_, [](const LiveMessage& message) { return !lasts(message); });
    for (LiveMessage& message : *messages_) message.arrival = now;
  }

  /// Whether it is sent once.
  static bool lasts(const LiveMessage& message) {
    return message.connection->latching || message.connection->topic == kStaticTransformsTopic;
  }

  Result<RecordingReader> try_open() {
    if (const std::string missing = missing_messages(); !missing.empty()) return failure(missing);
    // The fixed transforms heard before, behind those heard now, which come first.
    for (auto& [frames, message] : std::exchange(before_, {})) {
      message.arrival = messages_->back().arrival;
      messages_->push_back(std::move(message));
    }
    auto source = std::make_unique<LiveSource>(messages_, following());
    LiveSource& live = *source;
    auto reader = open_live(std::move(source), options_.config);
    if (!reader) return reader;
    if (auto ok = options_.check_setup(reader->setup()); !ok) return tl::unexpected(ok.error());
    if (const std::string few = few_messages(live); !few.empty()) return failure(few);
    // A record has each topic to its end: the truth too, which the estimate does not read. The next
    // estimate needs fixed transforms, which may be sent but once.
    for (const std::string& topic : subscribed_) {
      const bool needed = live.selects(topic) || topic == kStaticTransformsTopic;
      if (!observer_ && !needed) transport_.unsubscribe(topic);
    }
    if (forgot_) {
      show_mark(observer_, kForgottenTopic, live.summary().start, transport_.format());
    }
    live.go_live(observer_, options_.clocks);
    return reader;
  }

  /// Why the messages are not enough; empty: they are.
  std::string missing_messages() {
    const std::string own = transport_.resolved("~odometry");
    if (transport_.preceded(own)) {
      return fmt::format(
          "another program publishes {} (for 10 s after it was killed): end it, or choose another "
          "--node",
          own);
    }
    if (span() >= settle_) return {};
    if (span() > 0) return fmt::format("{:.1f} s of messages so far", to_seconds(span()));
    if (transport_.format() == kRos1Format || !messages_->empty() || subscribed_.empty()) {
      return "no messages yet" + transport_.place();
    }
    return fmt::format(
        "no messages yet, though there are publishers of {} topics: is their clock set? DDS "
        "drops what is sent from 2038 on; with --source-time aims_play alone is heard",
        subscribed_.size());
  }

  /// Which topic has come for so short a time that its period, unit or clock cannot be told, as the
  /// first cloud of a driver, which is part of a turn; empty: none.
  std::string few_messages(const LiveSource& live) const {
    std::set<std::string> seen;
    for (const LiveMessage& message : *messages_) {
      const std::string& topic = message.connection->topic;
      if (lasts(message) || !live.selects(topic) || !seen.insert(topic).second) continue;
      const Duration heard = messages_->back().arrival - message.arrival;
      if (heard < settle_) {
        return fmt::format("{:.1f} s of messages of {} so far", to_seconds(heard), topic);
      }
    }
    return {};
  }

  /// Waits for messages. Clouds may wait no longer than `max_wait` once none is waiting, at the
  /// latest after `kCatchUp`: before, the estimator catches up with what was gathered.
  LiveSource::Wait following() {
    return [&transport = transport_, &commands = commands_,
            max_wait = from_seconds(options_.live.max_wait), kept = options_.transforms,
            late = true, since_look = Stopwatch(),
            first = std::optional<Time>()]() mutable -> std::optional<LiveMessage> {
      while (transport.running() && !commands.restarts()) {
        auto message = commands.wait(late ? 0.0 : kPoll);
        if (message && !first) first = message->arrival;
        if (late && (!message || message->arrival > *first + kCatchUp)) {
          transport.limit_wait(max_wait);
          late = false;
        }
        if (since_look.seconds() > kLookPeriod) {
          since_look = Stopwatch();
          subscribe_to_late_transforms(transport);
        }
        if (!message) continue;
        keep(*message, kept);
        return message;
      }
      return std::nullopt;
    };
  }

  Duration span() const {
    return messages_->empty() ? 0 : messages_->back().arrival - messages_->front().arrival;
  }

  bool is_command(const std::string& topic) const {
    return topic == transport_.resolved("~command");
  }

  Transport& transport_;
  Commands& commands_;
  const LiveRecordingOptions& options_;
  Duration settle_;
  LiveSource::Observer observer_;  ///< records; none: nobody does
  LiveTransforms before_;          ///< heard before this gathering
  std::shared_ptr<LiveMessages> messages_ = std::make_shared<LiveMessages>();
  std::set<std::string> subscribed_;
  bool forgot_ = false;  ///< what the observer has seen
};

}  // namespace

Result<std::optional<RecordingReader>> open_live_recording(Transport& transport, Commands& commands,
                                                           const LiveRecordingOptions& options) {
  transport.limit_wait(
      std::max(from_seconds(options.live.max_wait), Inbox::kMaxWaitLarge));  // while it decides
  Gathering gathering(transport, commands, options);
  auto reader = gathering.wait_to_open();
  if (!reader || !*reader) gathering.show();
  return reader;
}

}  // namespace aims
