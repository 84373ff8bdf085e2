// SPDX-License-Identifier: BSD-3-Clause
#include "recordings/stream/recording_reader.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <utility>

#include "core/text.hpp"
#include "recordings/clouds/repeated_clouds.hpp"
#include "recordings/legs/joint_rates.hpp"
#include "recordings/legs/leg_stream.hpp"
#include "recordings/source/decided_start.hpp"
#include "recordings/source/rated_source.hpp"
#include "recordings/source/recording_file.hpp"
#include "recordings/stream/late_messages.hpp"
#include "recordings/stream/latency_trend.hpp"
#include "recordings/stream/record_clock.hpp"
#include "recordings/stream/recording_plan.hpp"
#include "recordings/stream/repeated_samples.hpp"
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

struct RecordingReader::Impl {
  /// A message whose record time lies before its stamp.
  struct Held {
    const BagConnection* connection = nullptr;
    std::vector<std::byte> data;
    std::optional<Time> sampled;
  };

  Impl(std::unique_ptr<MessageSource> source, RecordingChannels chosen, RecordingPlan decided,
       const RecordingConfig& configured)
      : bag(std::move(source)),
        summary(bag->summary()),
        channels(std::move(chosen)),
        plan(std::move(decided)),
        config(configured),
        turns(plan.cloud.parts, plan.cloud.period),
        legs(plan.legs),
        contact_detector(plan.contacts.thresholds) {
    for (const auto& [topic, period] : plan.repeat_period) repeats.emplace(topic, period);
    summary.start = plan.start;
  }

  Result<void> fetch();
  Time taken() const { return sampled.value_or(record_time); }  ///< in place of a stamp
  bool hold(const BagMessage& message, const Channel& channel, const MessageView& view);
  bool is_unset(const BagMessage& message, const Channel& channel, const MessageView& view) const;
  std::optional<Duration> lateness(const BagMessage& message, std::size_t role,
                                   const MessageView& view) const;
  Time arrival(const BagMessage& message, const Channel& channel, const MessageView& view);
  Time due(const BagMessage& message, const Channel& channel, const MessageView& view);
  void release(Time due, std::vector<Delivery>& out);
  void receive(const BagMessage& message, std::vector<Delivery>& out);
  bool is_repeated(const Channel& channel, const MessageView& view);
  void note_frame(Role role, const MessageView& view);
  void take(const Channel& channel, const MessageView& view, std::vector<Delivery>& out);
  void watch_frame(const MessageView& view);
  void watch_repeats(const PointTable& table);
  std::optional<LidarScan> read_scan(const PointTable& table);
  void take_cloud(const MessageView& view, std::vector<Delivery>& out);
  void take_imu(const MessageView& view, std::vector<Delivery>& out);
  void take_legs(const Channel& channel, const MessageView& view, std::vector<Delivery>& out);
  void take_feet(const Channel& channel, const MessageView& view, std::vector<Delivery>& out);
  void take_joints(const MessageView& view, std::vector<Delivery>& out);
  void take_contacts(const MessageView& view, std::vector<Delivery>& out);
  void take_truth(const MessageView& view);
  void deliver(Role role, Measurement measurement, Time stamp, std::vector<Delivery>& out);
  void deliver(std::optional<LegOdometrySample> sample, std::vector<Delivery>& out);
  void malformed(Role role);
  void count_late();
  void leave_out(const Channel& channel);
  Time stamp_of(Role role, Time stamp, double delay) const;
  Duration period_of(Role role) const;
  bool legs_by_joints() const { return plan.setup.topics.leg_odometry.empty(); }
  void warn_of_missing(Role role);
  void find_leap(const BagMessage& message, const Channel& channel, const MessageView& view);
  void note_latency(const BagMessage& message, const Channel& channel, const MessageView& view);
  void warn_of_leaps();
  void warn_of_imu_leap();
  void warn_of_rates();
  void finish(std::vector<Delivery>& out);

  std::unique_ptr<MessageSource> bag;
  BagSummary summary;  ///< without record times that were never set
  RecordingChannels channels;
  RecordingPlan plan;
  RecordingConfig config;
  TurnJoiner turns;  ///< of clouds that are parts of scans
  RepeatedClouds repeated_clouds;
  LegStream legs;
  ContactDetector contact_detector;
  std::map<std::string, RepeatFilter> repeats;  ///< by topic
  std::optional<BagMessage> next;               ///< read, not yet delivered
  std::multimap<Time, Held> held;               ///< by the time at which they are due
  std::size_t held_bytes = 0;
  bool started = false;
  Time until = 0;               ///< record time up to which messages have been delivered
  Time record_time = 0;         ///< of the current message
  std::optional<Time> sampled;  ///< likewise; where its record time is that of a batch
  Duration position = 0;
  std::array<std::optional<Time>, kRoleCount> last_stamps;
  std::array<std::string, kRoleCount> frames;  ///< of the first messages
  std::array<MissingMessages, kRoleCount> missing;
  std::array<LateMessages, kRoleCount> late_messages;
  std::array<LatencyTrend, kRoleCount> trends;
  SteadyTopic steady_imu;
  std::array<StampLeaps, kRoleCount> leaps;
  std::optional<Duration> leapt;  ///< by which the stamp of the current message is wrong
  Trajectory truth;
  std::optional<Time> last_true_stamp;
  EventCounts counts;
};

Result<void> RecordingReader::Impl::fetch() {
  auto message = bag->next();
  if (!message) return tl::unexpected(message.error());
  next = *message;
  return {};
}

/// The stamp of the delivery.
Time RecordingReader::Impl::stamp_of(Role role, Time stamp, double delay) const {
  const bool recorded = plan.stamped_by_record[static_cast<std::size_t>(role)];
  return (recorded ? taken() : stamp - leapt.value_or(0)) - from_seconds(delay);
}

void RecordingReader::Impl::deliver(Role role, Measurement measurement, Time stamp,
                                    std::vector<Delivery>& out) {
  auto& last = last_stamps[static_cast<std::size_t>(role)];
  if (last && stamp <= *last) ++counts[std::string(name_of(role)) + "_stamp_not_increasing"];
  last = stamp;  // so that one stamp far ahead counts once
  missing[static_cast<std::size_t>(role)].add(stamp, record_time, period_of(role));
  out.push_back({record_time + plan.arrival_shift, std::move(measurement)});
}

void RecordingReader::Impl::deliver(std::optional<LegOdometrySample> sample,
                                    std::vector<Delivery>& out) {
  if (!sample) return;
  const bool finite = sample->linear_velocity.allFinite() && sample->angular_velocity.allFinite() &&
                      sample->T_odom_base.translation.allFinite();
  if (!finite) ++counts["legs_not_finite"];
  const Time stamp = sample->stamp;
  deliver(Role::kLegs, *std::move(sample), stamp, out);
}

void RecordingReader::Impl::malformed(Role role) {
  ++counts[std::string(name_of(role)) + "_malformed"];
  // Of legs by joints, the periods are those of the joints.
  const Role counted = role == Role::kJoints && legs_by_joints() ? Role::kLegs : role;
  missing[static_cast<std::size_t>(counted)].add_unusable();
}

/// Counts a message of which nothing is read as one that came.
void RecordingReader::Impl::leave_out(const Channel& channel) {
  for (std::size_t i = 0; i < kRoleCount; ++i) {
    if (channel.serves[i]) missing[i].add_unusable();
  }
  if (channel.is(Role::kJoints) && legs_by_joints()) {
    missing[static_cast<std::size_t>(Role::kLegs)].add_unusable();
  }
}

/// Warns where the clouds come in another frame than the first ones.
void RecordingReader::Impl::watch_frame(const MessageView& view) {
  const std::string frame(view.text("header.frame_id").value_or(""));
  if (frame.empty() || plan.lidar_frame.empty() || frame == plan.lidar_frame) return;
  const std::string moved = plan.frames.moved(plan.lidar_frame, frame);
  if (moved.empty() || counts["lidar_frame_changed"]++ > 0) return;
  plan.setup.warnings.push_back(
      {"frame of the LiDAR changed",
       line_text(fmt::format("the clouds are in frame '{}' after {:.1f} s, in '{}' before: {}; "
                             "they are used as if it had not changed",
                             frame, to_seconds(position), plan.lidar_frame, moved)),
       WarnedSensor::kLidar});
}

/// Warns where the LiDAR hangs, once; what the warning counts grows.
void RecordingReader::Impl::watch_repeats(const PointTable& table) {
  constexpr const char* kReason = "the LiDAR repeats a cloud";
  repeated_clouds.add(table);
  if (!repeated_clouds.found()) return;
  counts["lidar_repeated_clouds"] = repeated_clouds.repeated();
  auto& warnings = plan.setup.warnings;
  auto warning = std::ranges::find(warnings, kReason, &ReadingWarning::reason);
  if (warning == warnings.end()) {
    warning = warnings.insert(warning, {kReason, "", WarnedSensor::kLidar});
  }
  warning->text = line_text(repeated_clouds_text(
      plan.setup.topics.lidar, repeated_clouds.repeated(), repeated_clouds.clouds()));
}

/// The scan of a cloud, or the one that it completes as the last part.
std::optional<LidarScan> RecordingReader::Impl::read_scan(const PointTable& table) {
  if (plan.cloud.parts.count == 1) return read_cloud(table, plan.cloud, counts);
  EventCounts of_part;
  auto turn = turns.add(read_cloud(table, plan.cloud, of_part));
  of_part.erase("cloud_empty");  // a part may see nothing
  for (const auto& [what, times] : of_part) counts[what] += times;
  return turn;
}

void RecordingReader::Impl::take_cloud(const MessageView& view, std::vector<Delivery>& out) {
  auto table = point_table(view);
  if (!table) return malformed(Role::kLidar);
  watch_frame(view);
  table->stamp = stamp_of(Role::kLidar, table->stamp, 0.0);
  watch_repeats(*table);
  auto read = read_scan(*table);
  if (!read && plan.cloud.parts.count == 1) {
    missing[static_cast<std::size_t>(Role::kLidar)].add_unusable();
  }
  if (!read) return;
  auto scan = std::make_shared<LidarScan>(std::move(*read));
  const Duration delay = from_seconds(config.lidar_delay);
  scan->stamp -= delay;
  scan->end -= delay;
  const Time stamp = scan->stamp;
  deliver(Role::kLidar, LidarScanPtr(std::move(scan)), stamp, out);
}

void RecordingReader::Impl::take_imu(const MessageView& view, std::vector<Delivery>& out) {
  const auto recorded = imu_at(view, taken(), counts);
  if (!recorded) return malformed(Role::kImu);
  ImuSample sample = *recorded;
  sample.stamp = stamp_of(Role::kImu, recorded->stamp, config.imu_delay);
  if (plan.force_scale != 1.0) sample.specific_force *= plan.force_scale;
  if (plan.turn_scale != 1.0) sample.angular_velocity *= plan.turn_scale;
  const bool finite = sample.angular_velocity.allFinite() && recorded->specific_force.allFinite();
  if (!finite) ++counts["imu_not_finite"];
  if (plan.begin && record_time < *plan.begin) return;
  legs.add_imu(sample);
  deliver(Role::kImu, sample, sample.stamp, out);
}

void RecordingReader::Impl::take_legs(const Channel& channel, const MessageView& view,
                                      std::vector<Delivery>& out) {
  if (plan.legs.source == LegSource::kFeet) return take_feet(channel, view, out);
  if (plan.legs.source == LegSource::kNone) return;
  const bool twist = plan.legs.source == LegSource::kTwist;
  auto sample = twist ? twist_at(view, taken()) : odometry_at(view, counts);
  if (!sample) return malformed(Role::kLegs);
  sample->stamp = stamp_of(Role::kLegs, sample->stamp, config.leg_delay);
  deliver(twist ? legs.add_twist(*sample) : legs.add_odometry(*sample, counts), out);
}

void RecordingReader::Impl::take_feet(const Channel& channel, const MessageView& view,
                                      std::vector<Delivery>& out) {
  auto feet = channel.state == nullptr ? std::nullopt : feet_at(view, taken(), *channel.state);
  if (!feet) return malformed(Role::kLegs);
  feet->stamp = stamp_of(Role::kLegs, feet->stamp, config.leg_delay);
  deliver(legs.add_feet(*feet, counts), out);
}

void RecordingReader::Impl::take_joints(const MessageView& view, std::vector<Delivery>& out) {
  auto joints = joints_at(view, taken(), plan.joints);
  if (!joints) return malformed(Role::kJoints);
  joints->stamp = stamp_of(Role::kJoints, joints->stamp, config.leg_delay);
  deliver(legs.add_joints(std::move(*joints), counts), out);
  while (auto more = legs.next(counts)) deliver(std::move(more), out);
}

void RecordingReader::Impl::take_contacts(const MessageView& view, std::vector<Delivery>& out) {
  const auto loads = loads_at(view, plan.contacts);
  if (!loads) return malformed(Role::kContacts);
  // Without a stamp they are as old as joints that arrive with them.
  const Duration age =
      sampled ? 0 : plan.latency[static_cast<std::size_t>(Role::kJoints)].value_or(0);
  const Time stamp = recorded_stamp(view) ? header_stamp(view, taken()) : taken() - age;
  const auto is_number = [](double load) { return std::isfinite(load); };
  if (!std::ranges::all_of(*loads, is_number)) ++counts["foot_loads_not_finite"];
  if (contact_detector.contradicts_sign(*loads)) ++counts["foot_loads_of_other_sign"];
  const ContactReading contacts = {stamp_of(Role::kContacts, stamp, config.leg_delay),
                                   contact_detector.detect(*loads), forces_at(view, plan.contacts)};
  deliver(legs.add_contacts(contacts, counts), out);
  while (auto more = legs.next(counts)) deliver(std::move(more), out);
}

void RecordingReader::Impl::take_truth(const MessageView& view) {
  auto pose = message_pose(view, "pose.pose", counts);
  if (!pose) pose = message_pose(view, "pose", counts);
  if (!pose) pose = message_pose(view, "transform", counts);
  const auto point = pose ? std::nullopt : vector_at(view, "point");
  if (point) pose = Pose{Eigen::Quaterniond::Identity(), *point};
  if (!pose) return malformed(Role::kTruth);
  const Time stamp = stamp_of(Role::kTruth, header_stamp(view, record_time), 0.0);
  if (!pose->translation.allFinite()) {
    ++counts["truth_not_finite"];
  } else if (last_true_stamp && stamp <= *last_true_stamp) {
    ++counts["truth_stamp_not_increasing"];
  } else {
    last_true_stamp = stamp;
    truth.push_back({stamp, plan.truth_is_of_body ? *pose : *pose * plan.T_truth_body});
  }
}

/// Whether the message is the sample before under a new stamp.
bool RecordingReader::Impl::is_repeated(const Channel& channel, const MessageView& view) {
  if (repeats.empty()) return false;
  const auto filter = repeats.find(channel.connection->topic);
  if (filter == repeats.end()) return false;
  return filter->second.repeats(header_stamp(view, taken()), sample_numbers(view, channel));
}

/// Counts messages of another frame than the first one of their topic, whose place they have.
void RecordingReader::Impl::note_frame(Role role, const MessageView& view) {
  const std::string_view frame = view.text("header.frame_id").value_or("");
  if (frame.empty()) return;
  std::string& first = frames[static_cast<std::size_t>(role)];
  if (first.empty()) first = frame;
  if (frame != first) ++counts[std::string(name_of(role)) + "_of_another_frame"];
}

void RecordingReader::Impl::take(const Channel& channel, const MessageView& view,
                                 std::vector<Delivery>& out) {
  if (is_repeated(channel, view)) {
    ++counts["repeated_samples"];
    return;
  }
  if (channel.is(Role::kTruth)) take_truth(view);
  for (const Role role : {Role::kLidar, Role::kImu}) {
    if (channel.is(role)) note_frame(role, view);
  }
  if (channel.is(Role::kLidar)) take_cloud(view, out);
  if (channel.is(Role::kImu)) take_imu(view, out);
  // Contacts first, where one message holds both: the joints then find those of their instant.
  if (channel.is(Role::kContacts)) take_contacts(view, out);
  if (channel.is(Role::kJoints)) take_joints(view, out);
  if (channel.is(Role::kLegs)) take_legs(channel, view, out);
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

/// By how much the stamp of a message is wrong, where it leapt and those of the IMU did not.
void RecordingReader::Impl::find_leap(const BagMessage& message, const Channel& channel,
                                      const MessageView& view) {
  const auto role = first_role(channel);
  if (!role || channel.is(Role::kTruth)) return;
  const auto late = lateness(message, *role, view);
  if (!late) return;
  if (channel.is(Role::kImu)) return steady_imu.add(*late, message.record_time);
  const Time stamp = message.record_time - *late - *plan.latency[*role];
  leapt = leaps[*role].add(stamp, *late, message.record_time, steady_imu);
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
  return std::max(record_time, message.record_time - *late);
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
  const auto of_current = std::exchange(leapt, std::nullopt);
  while (!held.empty() && held.begin()->first <= due) {
    const auto first = held.extract(held.begin());
    record_time = first.key();
    const Held& each = first.mapped();
    const BagMessage message = {each.connection, first.key(), each.data, 0, each.sampled};
    sampled = message.sampled;
    held_bytes -= message.data.size();
    const Channel* channel = channels.find(message);
    const auto view = channel->decoder.decode(message.data);
    if (view) take(*channel, *view, out);
  }
  leapt = of_current;
}

void RecordingReader::Impl::receive(const BagMessage& given, std::vector<Delivery>& out) {
  BagMessage message = given;
  leapt.reset();
  const Channel* channel = channels.find(message);
  if (channel == nullptr) return;
  const auto view = channel->decoder.decode(message.data);
  const bool unset = view && is_unset(given, *channel, *view);
  if (view && !unset && first_role(*channel) == static_cast<std::size_t>(Role::kTruth)) {
    // For scoring alone: it moves no arrival of a measurement.
    const Time last = std::exchange(record_time, message.record_time);
    sampled = message.sampled;
    take(*channel, *view, out);
    record_time = last;
    return;
  }
  if (view && !unset) note_latency(message, *channel, *view);
  if (view && !unset) find_leap(message, *channel, *view);
  if (view && !unset) message.record_time = arrival(message, *channel, *view);
  release(message.record_time, out);
  record_time = message.record_time;
  sampled = message.sampled;
  position = std::max(position, record_time - plan.start);
  if (!view) {
    for (std::size_t i = 0; i < kRoleCount; ++i) {
      if (channel->serves[i]) malformed(static_cast<Role>(i));
    }
    return;
  }
  if (unset) {
    ++counts["stamp_not_set"];
    return leave_out(*channel);
  }
  if (!hold(message, *channel, *view)) take(*channel, *view, out);
}

void RecordingReader::Impl::note_latency(const BagMessage& message, const Channel& channel,
                                         const MessageView& view) {
  const auto role = first_role(channel);
  const auto stamp = view.time("header.stamp");
  if (!role || !stamp || plan.stamped_by_record[*role] || plan.leaps[*role]) return;
  trends[*role].add(message.record_time, message.record_time - *stamp);
}

/// Of the messages of a sensor; 0: not known.
Duration RecordingReader::Impl::period_of(Role role) const {
  if (role == Role::kLidar) return plan.cloud.spacing * plan.cloud.parts.count;
  const auto& rate = role == Role::kImu ? plan.setup.imu_rate_hz : plan.setup.leg_rate_hz;
  return rate && *rate > 0.0 ? from_seconds(1.0 / *rate) : 0;
}

/// Warns of many messages that were not recorded.
void RecordingReader::Impl::warn_of_missing(Role role) {
  const MissingMessages& each = missing[static_cast<std::size_t>(role)];
  const auto lost = many_missing(role, each);
  if (!lost) return;
  counts[fmt::format("{}_messages_missing", name_of(role))] = static_cast<int>(*lost);
  const TopicsConfig& topics = plan.setup.topics;
  const bool by_joints = role == Role::kLegs && legs_by_joints();
  plan.setup.warnings.push_back(warning_of_missing(
      role, by_joints ? topics.joint_states : topic_of(topics, role), *lost, each));
}

/// Warns of stamps of one topic that leapt.
void RecordingReader::Impl::warn_of_leaps() {
  for (std::size_t i = 0; i < kRoleCount; ++i) {
    const Role role = static_cast<Role>(i);
    if (leaps[i].count() == 0) continue;
    counts[fmt::format("{}_stamps_leap", name_of(role))] = leaps[i].count();
    if (steady_imu.was_always_steady()) {  // the first one that leapt was no matter of the recorder
      counts.erase("recorded_before_their_stamp");
      counts.erase("recorded_long_after_their_stamp");
    }
    plan.setup.warnings.push_back(
        warning_of_leaps(role, topic_of(plan.setup.topics, role), leaps[i], plan.start));
  }
}

/// Warns of stamps of the IMU that leap while those of the LiDAR go on; the recorder is not to
/// blame.
void RecordingReader::Impl::warn_of_imu_leap() {
  constexpr auto kImu = static_cast<std::size_t>(Role::kImu);
  constexpr auto kLidar = static_cast<std::size_t>(Role::kLidar);
  if (steady_imu.was_always_steady() || leaps[kLidar].count() > 0) return;
  const auto step = trends[kImu].step(trends[kLidar]);
  if (!step || std::abs(*step) < SteadyTopic::kUsual) return;
  counts.erase("recorded_before_their_stamp");
  counts.erase("recorded_long_after_their_stamp");
  const TopicsConfig& topics = plan.setup.topics;
  plan.setup.warnings.push_back(warning_of_imu_leap(topics.imu, topics.lidar, -*step));
}

/// Warns of clocks that run at different rates.
void RecordingReader::Impl::warn_of_rates() {
  constexpr auto kImu = static_cast<std::size_t>(Role::kImu);
  const std::string& imu = plan.setup.topics.imu;
  for (const Role role : {Role::kLidar, Role::kLegs, Role::kJoints}) {
    const auto index = static_cast<std::size_t>(role);
    const auto growth = trends[kImu].growth(trends[index]);
    const std::string& topic = topic_of(plan.setup.topics, role);
    if (!growth || topic.empty() || topic == imu) continue;
    plan.setup.warnings.push_back(warning_of_rates(imu, topic, *growth));
    return;
  }
}

/// What the whole recording tells.
void RecordingReader::Impl::finish(std::vector<Delivery>& out) {
  release(std::numeric_limits<Time>::max(), out);
  warn_of_leaps();
  warn_of_imu_leap();
  warn_of_rates();
  warn_of_missing(Role::kImu);
  warn_of_missing(Role::kLidar);
  warn_of_missing(Role::kLegs);
  auto& warnings = plan.setup.warnings;
  for (ReadingWarning each : legs.warnings()) {
    // The start may have shown it already.
    const auto said = std::ranges::find(warnings, each.reason, &ReadingWarning::reason);
    if (said == warnings.end() || each.reason != kJointRates) warnings.push_back(std::move(each));
  }
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
const Trajectory& RecordingReader::truth() const { return impl_->truth; }
Trajectory RecordingReader::take_truth() { return std::exchange(impl_->truth, {}); }
const std::map<std::string, int>& RecordingReader::counts() const { return impl_->counts; }

}  // namespace aims
