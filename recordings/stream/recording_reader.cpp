// SPDX-License-Identifier: BSD-3-Clause
#include "recordings/stream/recording_reader.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <utility>

#include "recordings/source/decided_start.hpp"
#include "recordings/source/rated_source.hpp"
#include "recordings/source/recording_file.hpp"
#include "recordings/stream/delivery_maker.hpp"
#include "recordings/stream/late_messages.hpp"
#include "recordings/stream/record_clock.hpp"
#include "recordings/stream/recording_plan.hpp"
#include "recordings/stream/stamp_watch.hpp"
#include "recordings/stream/stream_warnings.hpp"
#include "recordings/topics/recording_channels.hpp"
#include "recordings/topics/topic_choice.hpp"

namespace aims {
namespace {

/// Limits of one call of `advance`, for many messages at one instant.
constexpr std::size_t kMaxDeliveries = 100'000;
constexpr std::size_t kMaxBytes = std::size_t{256} << 20;
/// Of a stamp 0 from the time at which its message was recorded, by the clock of the sensor.
constexpr Duration kMaxUnset = kSecond;
constexpr std::size_t kMaxHeldBytes = std::size_t{256} << 20;

/// The first role that the messages of a channel serve.
std::optional<std::size_t> first_role(const Channel& channel) {
  const auto* const serves = std::ranges::find(channel.serves, true);
  if (serves == channel.serves.end()) return std::nullopt;
  return static_cast<std::size_t>(serves - channel.serves.begin());
}

}  // namespace

/// In which order messages arrive, and when; `maker` makes deliveries of them.
struct RecordingReader::Impl {
  /// A message whose record time lies before its stamp.
  struct Held {
    const BagConnection* connection = nullptr;
    std::vector<std::byte> data;
    std::optional<Time> sampled;
  };

  Impl(std::unique_ptr<MessageSource> source, RecordingChannels chosen, RecordingPlan decided,
       const RecordingConfig& config)
      : bag(std::move(source)),
        summary(bag->summary()),
        channels(std::move(chosen)),
        maker(std::move(decided), config) {
    summary.start = plan.start;
  }

  Result<void> fetch();
  bool is_unset(const BagMessage& message, const Channel& channel, const MessageView& view) const;
  std::optional<Duration> lateness(const BagMessage& message, std::size_t role,
                                   const MessageView& view) const;
  void watch_stamp(const BagMessage& message, const Channel& channel, const MessageView& view);
  Time arrival(const BagMessage& message, const Channel& channel, const MessageView& view);
  Time due(const BagMessage& message, const Channel& channel, const MessageView& view);
  bool hold(const BagMessage& message, const Channel& channel, const MessageView& view);
  void count_late();
  void release(Time due, std::vector<Delivery>& out);
  void receive(const BagMessage& message, std::vector<Delivery>& out);
  void finish(std::vector<Delivery>& out);

  std::unique_ptr<MessageSource> bag;
  BagSummary summary;  ///< without record times that were never set
  RecordingChannels channels;
  DeliveryMaker maker;
  const RecordingPlan& plan = maker.plan;
  EventCounts& counts = maker.counts;
  StampWatch watch;
  std::array<LateMessages, kRoleCount> late_messages;
  std::optional<BagMessage> next;  ///< read, not yet delivered
  std::multimap<Time, Held> held;  ///< by the time at which they are due
  std::size_t held_bytes = 0;
  bool started = false;
  Time until = 0;        ///< record time up to which messages have been delivered
  Time record_time = 0;  ///< of the last message
  Duration position = 0;
  // Of the current message:
  std::optional<Duration> leapt;  ///< by which its stamp is wrong
  std::optional<Time> usual;      ///< when it would have been recorded, if it was late
};

Result<void> RecordingReader::Impl::fetch() {
  auto message = bag->next();
  if (!message) return tl::unexpected(message.error());
  next = *message;
  return {};
}

/// Whether the message has the stamp 0 though it was recorded at another time of its topic's clock:
/// before that clock was set.
bool RecordingReader::Impl::is_unset(const BagMessage& message, const Channel& channel,
                                     const MessageView& view) const {
  if (view.time("header.stamp").value_or(1) != 0) return false;
  for (std::size_t i = 0; i < kRoleCount; ++i) {
    if (!channel.serves[i] || plan.stamped_by_record[i] || !plan.latency[i]) continue;
    if (std::abs(message.record_time - *plan.latency[i]) > kMaxUnset) return true;
  }
  return false;
}

/// How long after its stamp and the usual latency a message was recorded; negative: before. Nothing
/// where its stamp does not tell.
std::optional<Duration> RecordingReader::Impl::lateness(const BagMessage& message, std::size_t role,
                                                        const MessageView& view) const {
  const auto stamp = view.time("header.stamp");
  if (!stamp || !plan.latency[role] || plan.leaps[role] || leapt) return std::nullopt;
  return message.record_time - (*stamp + *plan.latency[role]);
}

/// Notes the latency of a message, and by how much its stamp is wrong.
void RecordingReader::Impl::watch_stamp(const BagMessage& message, const Channel& channel,
                                        const MessageView& view) {
  const auto role = first_role(channel);
  const auto stamp = view.time("header.stamp");
  if (!role || !stamp) return;
  const Time recorded = message.record_time;
  if (!plan.stamped_by_record[*role] && !plan.leaps[*role]) {
    watch.add(static_cast<Role>(*role), recorded, recorded - *stamp);
  }
  const auto late = lateness(message, *role, view);
  if (!late || channel.is(Role::kTruth)) return;
  const Role leaping = channel.is(Role::kImu) ? Role::kImu : static_cast<Role>(*role);
  leapt = watch.leap_of(leaping, *stamp, *late, recorded);
}

/// When a message arrives. One that is recorded before its stamp, as after the recorder's clock was
/// set back or before it was set, is due at its stamp and the usual latency.
Time RecordingReader::Impl::due(const BagMessage& message, const Channel& channel,
                                const MessageView& view) {
  const Time recorded = message.record_time;
  const auto role = first_role(channel);
  if (!role) return recorded;
  const Duration early = -lateness(message, *role, view).value_or(0);
  const bool unset = recorded < kSetRecordTime && plan.start > kSetRecordTime;
  if (early < plan.max_early || (early > plan.max_hold && !unset))
    return recorded + plan.wait[*role];
  ++counts["recorded_before_their_stamp"];
  return recorded + early + plan.wait[*role];
}

/// When a message was recorded. Where the recorder's clock was set forward, or it read on late,
/// that is the usual latency after its stamp; arrivals never go back.
Time RecordingReader::Impl::arrival(const BagMessage& message, const Channel& channel,
                                    const MessageView& view) {
  const auto role = first_role(channel);
  const auto late = role ? lateness(message, *role, view) : std::nullopt;
  if (!late) return message.record_time;
  if (late_messages[*role].add(*late, message.record_time)) count_late();
  if (*late < LateMessages::kLate) return message.record_time;
  usual = message.record_time - *late;
  return std::max(record_time, *usual);
}

void RecordingReader::Impl::count_late() {
  int by_clock = 0, read_late = 0;
  for (const LateMessages& each : late_messages) {
    by_clock += each.by_clock();
    read_late += each.read_late();
  }
  const auto set = [this](const char* what, int count) {
    if (count > 0) counts[what] = count;
    if (count == 0) counts.erase(what);
  };
  set("recorded_long_after_their_stamp", by_clock);
  set("read_late_by_the_recorder", read_late);
}

/// Keeps a message that is not yet due.
bool RecordingReader::Impl::hold(const BagMessage& message, const Channel& channel,
                                 const MessageView& view) {
  const Time at = due(message, channel, view);
  if (at <= message.record_time || held_bytes + message.data.size() > kMaxHeldBytes) return false;
  held_bytes += message.data.size();
  held.emplace(
      at, Held{message.connection, {message.data.begin(), message.data.end()}, message.sampled});
  return true;
}

/// Takes the messages that are due, whose stamps are right.
void RecordingReader::Impl::release(Time due, std::vector<Delivery>& out) {
  while (!held.empty() && held.begin()->first <= due) {
    const auto first = held.extract(held.begin());
    const Held& each = first.mapped();
    const BagMessage message = {each.connection, first.key(), each.data, 0, each.sampled};
    held_bytes -= message.data.size();
    const Channel* channel = channels.find(message);
    const auto view = channel->decoder.decode(message.data);
    const MessageTimes times = {first.key(), each.sampled, std::nullopt, position};
    if (view) maker.take(*channel, *view, times, out);
  }
}

void RecordingReader::Impl::receive(const BagMessage& given, std::vector<Delivery>& out) {
  BagMessage message = given;
  leapt.reset();
  usual.reset();
  const Channel* channel = channels.find(message);
  if (channel == nullptr) return;
  const auto view = channel->decoder.decode(message.data);
  const bool unset = view && is_unset(given, *channel, *view);
  const bool readable = view && !unset;
  if (readable && first_role(*channel) == static_cast<std::size_t>(Role::kTruth)) {
    // For scoring alone: it moves no arrival of a measurement.
    const MessageTimes times = {message.record_time, message.sampled, std::nullopt, position};
    return maker.take(*channel, *view, times, out);
  }
  if (readable) {
    watch_stamp(message, *channel, *view);
    message.record_time = arrival(message, *channel, *view);
  }
  release(message.record_time, out);
  record_time = message.record_time;
  position = std::max(position, record_time - plan.start);
  if (unset) {
    ++counts["stamp_not_set"];
    maker.leave_out(*channel, record_time);
  }
  for (std::size_t i = 0; i < kRoleCount && !view; ++i) {
    if (channel->serves[i]) maker.malformed(static_cast<Role>(i), record_time, record_time);
  }
  if (!readable || hold(message, *channel, *view)) return;
  maker.take(*channel, *view, {record_time, message.sampled, leapt, position, usual}, out);
}

/// What the whole recording tells.
void RecordingReader::Impl::finish(std::vector<Delivery>& out) {
  release(std::numeric_limits<Time>::max(), out);
  watch.finish(maker.plan, counts);
  maker.finish();
  const auto repeated = static_cast<int>(bag->summary().repeated_messages);
  if (repeated > 0) counts["recorded_in_two_files"] = repeated;
}

Result<RecordingReader> RecordingReader::open(const std::filesystem::path& file,
                                              const RecordingConfig& config,
                                              BagOpenOptions options) {
  options.as_live = config.as_live;
  auto source = open_sensor_recording(file, options, config.topics.lidar == "none");
  if (!source) return tl::unexpected(source.error());
  return open_source(std::move(*source), config, true);
}

Result<RecordingReader> RecordingReader::open(std::unique_ptr<MessageSource> source,
                                              const RecordingConfig& config) {
  return open_source(std::move(source), config, false);
}

Result<RecordingReader> RecordingReader::open_source(std::unique_ptr<MessageSource> bag,
                                                     const RecordingConfig& config, bool recorded) {
  const std::filesystem::path name = bag->name();
  std::vector<std::string> notes;
  const auto topics = choose_topics(name, bag->connections(), config.topics, notes);
  if (!topics) return tl::unexpected(topics.error());
  auto channels = RecordingChannels::create(name, bag->connections(), *topics);
  if (!channels) return tl::unexpected(channels.error());
  const auto doubled = doubled_topics(*bag);
  if (!doubled) return tl::unexpected(doubled.error());
  DecidedStart start(*bag);
  const bool as_live = config.as_live && is_of_live_estimate(*bag);
  if (as_live) {
    notes.push_back(
        "units, clocks and contacts: decided as by the live estimate that recorded it, from what "
        "it had heard (as_live)");
    if (has_forgotten(*bag)) {
      notes.push_back(
          "what the live estimate heard long before it could start is left out (as_live)");
    }
  }
  auto plan = plan_recording(as_live ? start : *bag, config, *topics, *channels, notes);
  if (!plan) return tl::unexpected(plan.error());
  if (const auto rate = recorded && !as_live ? plan->record_rate : std::nullopt) {
    bag = std::make_unique<RatedSource>(std::move(bag), *rate, plan->start);
    plan = plan_recording(*bag, config, *topics, *channels, std::move(notes));
    if (!plan) return tl::unexpected(plan.error());
    plan->setup.warnings.push_back(warning_of_record_rate(*rate));
  }
  for (const std::string& each : *doubled) {
    plan->setup.warnings.push_back(warning_of_publishers(each));
  }
  bag->select(channels->topics());
  bag->rewind();
  return RecordingReader(
      std::make_unique<Impl>(std::move(bag), std::move(*channels), std::move(*plan), config));
}

Result<void> check_legs(const RecordingSetup& setup, const std::string& estimator,
                        const std::string& naming) {
  if (setup.has_legs) return {};
  return failure(fmt::format(
      "estimator {} needs leg odometry, which is not found{}; name its topic ({}), or use an "
      "estimator without legs, e.g. lio",
      estimator, setup.leg_lack.empty() ? "" : fmt::format(" ({})", setup.leg_lack), naming));
}

Result<bool> RecordingReader::advance(Duration span, std::vector<Delivery>& deliveries) {
  Impl& impl = *impl_;
  if (!impl.started) {
    if (auto ok = impl.fetch(); !ok) return tl::unexpected(ok.error());
    impl.started = true;
    if (impl.next) impl.until = impl.next->record_time;
  }
  if (!impl.next) return false;
  // A gap in the recording is passed at once.
  impl.until = std::max(impl.until, impl.next->record_time);
  impl.until = impl.until > std::numeric_limits<Time>::max() - span
                   ? std::numeric_limits<Time>::max()
                   : impl.until + span;
  const std::size_t before = deliveries.size();
  std::size_t bytes = 0;
  while (impl.next && impl.next->record_time < impl.until) {
    if (bytes > kMaxBytes || deliveries.size() - before > kMaxDeliveries) break;
    bytes += impl.next->data.size();
    impl.receive(*impl.next, deliveries);
    impl.next.reset();
    if (auto ok = impl.fetch(); !ok) return tl::unexpected(ok.error());
  }
  if (!impl.next) impl.finish(deliveries);
  return impl.next.has_value();
}

RecordingReader::RecordingReader(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
RecordingReader::RecordingReader(RecordingReader&&) noexcept = default;
RecordingReader& RecordingReader::operator=(RecordingReader&&) noexcept = default;
RecordingReader::~RecordingReader() = default;

const RecordingSetup& RecordingReader::setup() const { return impl_->plan.setup; }
const BagSummary& RecordingReader::summary() const { return impl_->summary; }
Duration RecordingReader::position() const { return impl_->position; }
const Trajectory& RecordingReader::truth() const { return impl_->maker.truth; }
Trajectory RecordingReader::take_truth() { return std::exchange(impl_->maker.truth, {}); }
const std::map<std::string, int>& RecordingReader::counts() const { return impl_->counts; }

}  // namespace aims
