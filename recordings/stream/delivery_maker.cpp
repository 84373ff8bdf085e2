// SPDX-License-Identifier: BSD-3-Clause
#include "recordings/stream/delivery_maker.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <utility>

#include "core/text.hpp"
#include "recordings/stream/stream_warnings.hpp"

namespace aims {

DeliveryMaker::DeliveryMaker(RecordingPlan decided, const RecordingConfig& config)
    : plan(std::move(decided)),
      config_(config),
      turns_(plan.cloud.parts, plan.cloud.period),
      legs_(plan.legs),
      contact_detector_(plan.contacts.thresholds) {
  for (const auto& [topic, period] : plan.repeat_period) repeats_.emplace(topic, period);
}

/// The stamp of the delivery.
Time DeliveryMaker::stamp_of(Role role, Time stamp, double delay) const {
  const bool recorded = plan.stamped_by_record[static_cast<std::size_t>(role)];
  return (recorded ? now_.taken() : stamp - now_.leapt.value_or(0)) - from_seconds(delay);
}

void DeliveryMaker::deliver(Role role, Measurement measurement, Time stamp,
                            std::vector<Delivery>& out) {
  auto& last = last_stamps_[static_cast<std::size_t>(role)];
  if (last && stamp <= *last) ++counts[std::string(name_of(role)) + "_stamp_not_increasing"];
  last = stamp;  // so that one stamp far ahead counts once
  missing(role).add(stamp, heard_at(), arrived_at(), period_of(role));
  out.push_back({now_.recorded + plan.arrival_shift, std::move(measurement)});
}

void DeliveryMaker::deliver(std::optional<LegOdometrySample> sample, std::vector<Delivery>& out) {
  for (; left_out_ < legs_left_out(); ++left_out_)
    missing(Role::kLegs).add_unusable(heard_at(), arrived_at());
  if (!sample) return;
  const bool finite = sample->linear_velocity.allFinite() && sample->angular_velocity.allFinite() &&
                      sample->T_odom_base.translation.allFinite();
  if (!finite) ++counts["legs_not_finite"];
  const Time stamp = sample->stamp;
  deliver(Role::kLegs, *std::move(sample), stamp, out);
}

/// Samples of legs without contacts, gyro or rates, or of a robot that is carried or lies.
int DeliveryMaker::legs_left_out() const {
  int all = 0;
  for (const char* what : {"legs_without_contacts", "legs_incomplete", "legs_in_the_air"}) {
    if (const auto found = counts.find(what); found != counts.end()) all += found->second;
  }
  return all;
}

void DeliveryMaker::malformed(Role role, Time recorded, Time arrived) {
  ++counts[std::string(name_of(role)) + "_malformed"];
  missing(role).add_unusable(recorded, arrived);
  // Of legs by joints, the periods are those of the joints.
  if (role == Role::kJoints && legs_by_joints())
    missing(Role::kLegs).add_unusable(recorded, arrived);
}

void DeliveryMaker::leave_out(const Channel& channel, Time recorded) {
  for (std::size_t i = 0; i < kRoleCount; ++i) {
    if (channel.serves[i]) missing_[i].add_unusable(recorded, recorded);
  }
  if (channel.is(Role::kJoints) && legs_by_joints())
    missing(Role::kLegs).add_unusable(recorded, recorded);
}

/// When the current message was recorded, without what the recorder was late or held it for.
Time DeliveryMaker::heard_at() const {
  return std::min(now_.usual.value_or(now_.recorded), plan.start + now_.position);
}

/// When it arrived: never before those of other topics that came before it.
Time DeliveryMaker::arrived_at() const {
  return std::min(now_.recorded, plan.start + now_.position);
}

/// Warns where the clouds come in another frame than the first ones.
void DeliveryMaker::watch_frame(const MessageView& view) {
  const std::string frame(view.text("header.frame_id").value_or(""));
  if (frame.empty() || plan.lidar_frame.empty() || frame == plan.lidar_frame) return;
  const std::string moved = plan.frames.moved(plan.lidar_frame, frame);
  if (moved.empty() || counts["lidar_frame_changed"]++ > 0) return;
  plan.setup.warnings.push_back(
      {"frame of the LiDAR changed",
       line_text(fmt::format("the clouds are in frame '{}' after {:.1f} s, in '{}' before: {}; "
                             "they are used as if it had not changed",
                             frame, to_seconds(now_.position), plan.lidar_frame, moved)),
       WarnedSensor::kLidar});
}

/// Warns where the LiDAR hangs, once; what the warning counts grows.
void DeliveryMaker::watch_repeats(const PointTable& table) {
  constexpr auto kKind = WarningKind::kRepeatedClouds;
  repeated_clouds_.add(table);
  if (!repeated_clouds_.found()) return;
  counts["lidar_repeated_clouds"] = repeated_clouds_.repeated();
  auto& warnings = plan.setup.warnings;
  auto warning = std::ranges::find(warnings, kKind, &ReadingWarning::kind);
  if (warning == warnings.end()) {
    warning =
        warnings.insert(warning, {"the LiDAR repeats a cloud", "", WarnedSensor::kLidar, kKind});
  }
  warning->text = line_text(repeated_clouds_text(
      plan.setup.topics.lidar, repeated_clouds_.repeated(), repeated_clouds_.clouds()));
}

/// The scan of a cloud, or the one that it completes as the last part.
std::optional<LidarScan> DeliveryMaker::read_scan(const PointTable& table) {
  if (plan.cloud.parts.count == 1) return read_cloud(table, plan.cloud, counts);
  EventCounts of_part;
  auto turn = turns_.add(read_cloud(table, plan.cloud, of_part));
  of_part.erase("cloud_empty");  // a part may see nothing
  for (const auto& [what, times] : of_part) counts[what] += times;
  return turn;
}

void DeliveryMaker::take_cloud(const MessageView& view, std::vector<Delivery>& out) {
  auto table = point_table(view);
  if (!table) return malformed(Role::kLidar, heard_at(), arrived_at());
  watch_frame(view);
  table->stamp = stamp_of(Role::kLidar, table->stamp, 0.0);
  watch_repeats(*table);
  auto read = read_scan(*table);
  if (!read && plan.cloud.parts.count == 1)
    missing(Role::kLidar).add_unusable(heard_at(), arrived_at());
  if (!read) return;
  auto scan = std::make_shared<LidarScan>(std::move(*read));
  const Duration delay = from_seconds(config_.lidar_delay);
  scan->stamp -= delay;
  scan->end -= delay;
  const Time stamp = scan->stamp;
  deliver(Role::kLidar, LidarScanPtr(std::move(scan)), stamp, out);
}

void DeliveryMaker::take_imu(const MessageView& view, std::vector<Delivery>& out) {
  const auto recorded = imu_at(view, now_.taken(), counts);
  if (!recorded) return malformed(Role::kImu, heard_at(), arrived_at());
  ImuSample sample = *recorded;
  sample.stamp = stamp_of(Role::kImu, recorded->stamp, config_.imu_delay);
  if (plan.force_scale != 1.0) sample.specific_force *= plan.force_scale;
  if (plan.turn_scale != 1.0) sample.angular_velocity *= plan.turn_scale;
  const bool finite = sample.angular_velocity.allFinite() && recorded->specific_force.allFinite();
  if (!finite) ++counts["imu_not_finite"];
  if (plan.begin && now_.recorded < *plan.begin) return;
  legs_.add_imu(sample);
  deliver(Role::kImu, sample, sample.stamp, out);
}

void DeliveryMaker::take_legs(const Channel& channel, const MessageView& view,
                              std::vector<Delivery>& out) {
  if (plan.legs.source == LegSource::kFeet) return take_feet(channel, view, out);
  if (plan.legs.source == LegSource::kNone) return;
  const bool twist = plan.legs.source == LegSource::kTwist;
  auto sample = twist ? twist_at(view, now_.taken()) : odometry_at(view, counts);
  if (!sample) return malformed(Role::kLegs, heard_at(), arrived_at());
  sample->stamp = stamp_of(Role::kLegs, sample->stamp, config_.leg_delay);
  deliver(twist ? legs_.add_twist(*sample) : legs_.add_odometry(*sample, counts), out);
}

void DeliveryMaker::take_feet(const Channel& channel, const MessageView& view,
                              std::vector<Delivery>& out) {
  auto feet = channel.state == nullptr ? std::nullopt : feet_at(view, now_.taken(), *channel.state);
  if (!feet) return malformed(Role::kLegs, heard_at(), arrived_at());
  feet->stamp = stamp_of(Role::kLegs, feet->stamp, config_.leg_delay);
  deliver(legs_.add_feet(*feet, counts), out);
}

void DeliveryMaker::take_joints(const MessageView& view, std::vector<Delivery>& out) {
  auto joints = joints_at(view, now_.taken(), plan.joints);
  if (!joints) return malformed(Role::kJoints, heard_at(), arrived_at());
  joints->stamp = stamp_of(Role::kJoints, joints->stamp, config_.leg_delay);
  missing(Role::kJoints).add(joints->stamp, heard_at(), arrived_at(), period_of(Role::kJoints));
  deliver(legs_.add_joints(std::move(*joints), counts), out);
  while (auto more = legs_.next(counts)) deliver(std::move(more), out);
}

void DeliveryMaker::take_contacts(const MessageView& view, std::vector<Delivery>& out) {
  const auto loads = loads_at(view, plan.contacts);
  if (!loads) return malformed(Role::kContacts, heard_at(), arrived_at());
  // Without a stamp they are as old as joints that arrive with them.
  const Duration age =
      now_.sampled ? 0 : plan.latency[static_cast<std::size_t>(Role::kJoints)].value_or(0);
  const Time stamp = recorded_stamp(view) ? header_stamp(view, now_.taken()) : now_.taken() - age;
  const auto is_number = [](double load) { return std::isfinite(load); };
  if (!std::ranges::all_of(*loads, is_number)) ++counts["foot_loads_not_finite"];
  if (contact_detector_.contradicts_sign(*loads)) ++counts["foot_loads_of_other_sign"];
  const ContactReading contacts = {stamp_of(Role::kContacts, stamp, config_.leg_delay),
                                   contact_detector_.detect(*loads),
                                   forces_at(view, plan.contacts)};
  missing(Role::kContacts)
      .add(contacts.stamp, heard_at(), arrived_at(), period_of(Role::kContacts));
  deliver(legs_.add_contacts(contacts, counts), out);
  while (auto more = legs_.next(counts)) deliver(std::move(more), out);
}

void DeliveryMaker::take_truth(const MessageView& view) {
  auto pose = message_pose(view, "pose.pose", counts);
  if (!pose) pose = message_pose(view, "pose", counts);
  if (!pose) pose = message_pose(view, "transform", counts);
  const auto point = pose ? std::nullopt : vector_at(view, "point");
  if (point) pose = Pose{Eigen::Quaterniond::Identity(), *point};
  if (!pose) return malformed(Role::kTruth, heard_at(), arrived_at());
  const Time stamp = stamp_of(Role::kTruth, header_stamp(view, now_.recorded), 0.0);
  if (!pose->translation.allFinite()) {
    ++counts["truth_not_finite"];
  } else if (last_true_stamp_ && stamp <= *last_true_stamp_) {
    ++counts["truth_stamp_not_increasing"];
  } else {
    last_true_stamp_ = stamp;
    truth.push_back({stamp, plan.truth_is_of_body ? *pose : *pose * plan.T_truth_body});
  }
}

/// Whether the message is the sample before under a new stamp.
bool DeliveryMaker::is_repeated(const Channel& channel, const MessageView& view) {
  if (repeats_.empty()) return false;
  const auto filter = repeats_.find(channel.connection->topic);
  if (filter == repeats_.end()) return false;
  return filter->second.repeats(header_stamp(view, now_.taken()), sample_numbers(view, channel));
}

/// Counts messages of another frame than the first one of their topic, whose place they have.
void DeliveryMaker::note_frame(Role role, const MessageView& view) {
  const std::string_view frame = view.text("header.frame_id").value_or("");
  if (frame.empty()) return;
  std::string& first = frames_[static_cast<std::size_t>(role)];
  if (first.empty()) first = frame;
  if (frame != first) ++counts[std::string(name_of(role)) + "_of_another_frame"];
}

void DeliveryMaker::take(const Channel& channel, const MessageView& view, const MessageTimes& times,
                         std::vector<Delivery>& out) {
  now_ = times;
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

/// Of the messages of a sensor; 0: not known.
Duration DeliveryMaker::period_of(Role role) const {
  if (role == Role::kLidar) return plan.cloud.spacing * plan.cloud.parts.count;
  if (role == Role::kJoints) return plan.joint_period;
  if (role == Role::kContacts) return plan.contact_period;
  const auto& rate = role == Role::kImu ? plan.setup.imu_rate_hz : plan.setup.leg_rate_hz;
  return rate && *rate > 0.0 ? from_seconds(1.0 / *rate) : 0;
}

/// Whose messages the role's are.
Role DeliveryMaker::source_of(Role role) const {
  return role == Role::kLegs && legs_by_joints() ? Role::kJoints : role;
}

/// Warns of many messages that were not recorded.
void DeliveryMaker::warn_of_missing(Role role) {
  const auto lost = many_missing(role, missing(role));
  if (!lost) return;
  // Joints and contacts that are missing as the legs are need no word of their own.
  constexpr double kAlike = 0.05;
  const bool beside = role == Role::kJoints || role == Role::kContacts;
  const MissingMessages& legs = missing(Role::kLegs);
  if (beside && many_missing(Role::kLegs, legs) &&
      missing(role).fraction() < legs.fraction() + kAlike) {
    return;
  }
  counts[fmt::format("{}_messages_missing", name_of(role))] = static_cast<int>(*lost);
  plan.setup.warnings.push_back(
      warning_of_missing(role, topic_of(plan.setup.topics, source_of(role)), *lost, missing(role)));
}

/// Warns of a sensor that was heard long after the first one, or not until the end.
void DeliveryMaker::warn_of_absence(Role role, Time begin, Time end) {
  const auto& heard = missing(source_of(role)).heard();
  if (!heard || period_of(role) <= 0) return;
  const auto& legs = missing(source_of(Role::kLegs)).heard();
  const bool beside = legs && (role == Role::kJoints || role == Role::kContacts);
  if (beside) begin = std::max(begin, legs->first), end = std::min(end, legs->second);
  const std::string& topic = topic_of(plan.setup.topics, source_of(role));
  if (role == Role::kLegs && topic == plan.setup.topics.imu) return;  // said of the IMU
  const auto warn = [&](bool late, Duration absence) {
    if (absence <= MissingMessages::kLong) return;
    plan.setup.warnings.push_back(warning_of_absence(role, topic, late, absence));
  };
  warn(true, heard->first - begin);
  warn(false, end - heard->second);
}

void DeliveryMaker::finish() {
  constexpr auto kSensors =
      std::to_array({Role::kImu, Role::kLidar, Role::kLegs, Role::kJoints, Role::kContacts});
  Time begin = std::numeric_limits<Time>::max(), end = std::numeric_limits<Time>::min();
  for (const Role role : kSensors) {
    warn_of_missing(role);
    const auto& heard = missing(role).heard();
    if (!heard) continue;
    begin = std::min(begin, heard->first);
    end = std::max(end, heard->second);
  }
  begin = std::max(begin, plan.start);  // not of a clock that was not set yet
  for (const Role role : kSensors) warn_of_absence(role, begin, end);
  auto& warnings = plan.setup.warnings;
  for (ReadingWarning each : legs_.warnings()) {
    // The start may have shown it already.
    const bool said =
        each.kind == WarningKind::kJointRates &&
        std::ranges::find(warnings, each.kind, &ReadingWarning::kind) != warnings.end();
    if (!said) warnings.push_back(std::move(each));
  }
}

}  // namespace aims
