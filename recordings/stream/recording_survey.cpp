// SPDX-License-Identifier: BSD-3-Clause
#include "recordings/stream/recording_survey.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "recordings/clouds/scan_period.hpp"
#include "recordings/median.hpp"
#include "recordings/messages/message_types.hpp"
#include "recordings/stream/gravity_unit.hpp"

namespace aims {
namespace {

constexpr std::size_t kMaxSamples = 2000;
constexpr double kMaxTurnRate = 35.0;  ///< saturation of a gyro of 2000 deg/s [rad/s]
/// Larger differences mean that recorder and sensors use different clocks.
constexpr Duration kMaxClockDifference = 5 * kSecond;

bool all_zero(const std::vector<Time>& stamps) {
  return stamps.size() >= 3 &&
         std::all_of(stamps.begin(), stamps.end(), [](Time stamp) { return stamp == 0; });
}

/// Replaces the nominal rate of a sensor by the measured one where they differ by more than 10 %.
void adopt_rate(std::optional<double> measured_hz, const char* sensor, double& nominal_hz,
                std::vector<std::string>& notes) {
  constexpr double kTolerance = 0.1;
  if (!measured_hz || std::abs(*measured_hz - nominal_hz) <= kTolerance * nominal_hz) return;
  nominal_hz = *measured_hz;
  notes.push_back(
      fmt::format("{}: {:.4g} Hz, the rate found in the recording", sensor, *measured_hz));
}

}  // namespace

void RecordingSurvey::note_times(Role role, const MessageView& view, Time record_time) {
  Seen& each = seen(role);
  if (each.stamps.size() >= kMaxSamples) return;
  const Time stamp = header_stamp(view, record_time);
  each.stamps.push_back(stamp);
  each.latencies.push_back(record_time - stamp);
  if (each.frame.empty()) each.frame = view.text("header.frame_id").value_or("");
  if (each.child_frame.empty()) each.child_frame = view.text("child_frame_id").value_or("");
}

void RecordingSurvey::add(const BagMessage& message, const Channel& channel) {
  const auto view = channel.decoder.decode(message.data);
  if (!view) {
    if (channel.is(Role::kLidar) && cloud_error_.empty()) cloud_error_ = view.error().message;
    return;
  }
  for (std::size_t i = 0; i < kRoleCount; ++i) {
    if (!channel.serves[i]) continue;
    note_times(static_cast<Role>(i), *view, message.record_time);
    seen_[i].type = channel.connection->type;
  }
  if (channel.is(Role::kLidar)) add_cloud(*view, message.record_time);
  if (channel.is(Role::kImu)) add_imu(*view);
  if (channel.is(Role::kLegs)) legs_.add_feet(*view);
  if (channel.is(Role::kJoints)) legs_.add_joints(*view, message.record_time);
  if (channel.is(Role::kContacts)) {
    legs_.add_contacts(*view, channel.connection->type, channel.decoder);
  }
}

void RecordingSurvey::add_cloud(const MessageView& view, Time record_time) {
  const auto table = point_table(view);
  if (table) return clouds_.add(*table, record_time);
  if (cloud_error_.empty()) cloud_error_ = table.error().message;
}

void RecordingSurvey::add_imu(const MessageView& view) {
  EventCounts ignored;
  const auto sample = imu_at(view, 0, ignored);
  if (!sample || !sample->specific_force.allFinite()) return;
  if (!sample->angular_velocity.allFinite()) return;
  if (forces_.size() < kMaxSamples) forces_.push_back(sample->specific_force.norm());
  largest_turn_rate_ = std::max(largest_turn_rate_, sample->angular_velocity.norm());
  oriented_ = oriented_ || sample->orientation.has_value();
}

bool RecordingSurvey::has_all_topics() const {
  for (std::size_t i = 0; i < kRoleCount; ++i) {
    const Role role = static_cast<Role>(i);
    if (role == Role::kTruth || topic_of(topics_, role).empty()) continue;
    if (seen(role).stamps.empty()) return false;
  }
  return true;
}

bool RecordingSurvey::enough() const {
  const bool lidar = topics_.lidar.empty() || clouds_.enough();
  const bool imu = topics_.imu.empty() || seen(Role::kImu).stamps.size() >= 200;
  return lidar && imu && has_all_topics();
}

/// Clocks: stamps that were never set, and a recorder clock that differs from the sensors'.
void RecordingSurvey::decide_stamps(RecordingPlan& plan) const {
  std::vector<std::string>& notes = plan.setup.notes;
  std::optional<Duration> imu, lidar;
  for (std::size_t i = 0; i < kRoleCount; ++i) {
    const Role role = static_cast<Role>(i);
    const std::string& topic = topic_of(topics_, role);
    if (topic.empty()) continue;
    if (seen_[i].stamps.empty()) {
      if (role != Role::kTruth) notes.push_back(fmt::format("{}: no message at the start", topic));
      continue;
    }
    if (all_zero(seen_[i].stamps)) {
      plan.stamped_by_record[i] = true;
      notes.push_back(fmt::format("{}: stamps are all zero, record times are used", topic));
      continue;
    }
    const Duration latency = *upper_median(seen_[i].latencies);
    if (role == Role::kImu) imu = latency;
    if (role == Role::kLidar) lidar = latency;
    const std::optional<Duration> first = imu ? imu : lidar;
    if (role != Role::kTruth && first && std::abs(latency - *first) > kSecond) {
      notes.push_back(fmt::format(
          "{}: stamps are {:.3f} s behind those of other topics: set recording.{}_delay", topic,
          to_seconds(latency - *first), role == Role::kLidar ? "lidar" : "leg"));
    }
  }
  const std::optional<Duration> first = imu ? imu : lidar;
  if (!first || std::abs(*first) < kMaxClockDifference) return;
  plan.arrival_shift = -*first;
  notes.push_back(fmt::format(
      "the recorder's clock is {:.3f} s ahead of the sensors': arrivals are shifted by it",
      to_seconds(*first)));
}

void RecordingSurvey::decide_imu(RecordingPlan& plan) const {
  std::vector<std::string>& notes = plan.setup.notes;
  plan.setup.imu_rate_hz = sample_rate(seen(Role::kImu).stamps);
  plan.setup.has_orientation = oriented_;
  adopt_rate(plan.setup.imu_rate_hz, "IMU", plan.setup.rig.imu_rate_hz, notes);
  const double force = upper_median(forces_).value_or(0.0);
  bool gravities = config_.imu_unit == ImuUnit::kGravities;
  if (config_.imu_unit == ImuUnit::kAuto && !forces_.empty()) {
    gravities = is_in_gravities(force);
    if (!gravities && (force < 5.0 || force > 15.0)) {
      notes.push_back(
          fmt::format("specific force of {:.3g} at the start is neither gravity in m/s^2 "
                      "nor in g: assumed to be m/s^2 (imu_unit)",
                      force));
    }
  }
  if (gravities) {
    plan.force_scale = kStandardGravity;
    notes.push_back(
        fmt::format("IMU in g ({:.3f} at the start): multiplied by {}", force, kStandardGravity));
  }
  if (seen(Role::kImu).type == kUnitreeLowState) {
    notes.push_back(fmt::format("{} has no stamp: record times are used", kUnitreeLowState));
  }
  if (largest_turn_rate_ > kMaxTurnRate) {
    notes.push_back(fmt::format(
        "angular velocity up to {:.3g}: rad/s are expected, are these deg/s?", largest_turn_rate_));
  }
}

Result<void> RecordingSurvey::decide_legs(RecordingPlan& plan) const {
  const Seen& legs = seen(Role::kLegs);
  auto contacts = legs_.decide_contacts(plan.setup.notes);
  if (!contacts) return tl::unexpected(contacts.error());
  plan.contacts = std::move(*contacts);
  LegStreamConfig& stream = plan.legs;
  stream.geometry = config_.leg_geometry;
  stream.foot_model = config_.foot_model;
  stream.source = legs_.decide_source(legs.type, legs.frame, plan.setup.notes);
  const bool kinematic = stream.source == LegSource::kKinematics;
  plan.setup.leg_rate_hz = sample_rate(kinematic ? seen(Role::kJoints).stamps : legs.stamps);
  plan.setup.has_legs = stream.source != LegSource::kNone;
  plan.setup.has_joints = legs_.has_joints_and_contacts();
  plan.setup.rig.leg_geometry = config_.leg_geometry;
  adopt_rate(plan.setup.leg_rate_hz, "leg odometry", plan.setup.rig.leg_rate_hz, plan.setup.notes);
  const double rate = plan.setup.leg_rate_hz.value_or(100.0);
  stream.half_period = from_seconds(std::clamp(0.5 / rate, 1e-9, 0.5));
  return {};
}

std::string RecordingSurvey::imu_frame() const {
  return config_.imu_frame.empty() ? seen(Role::kImu).frame : config_.imu_frame;
}

std::string RecordingSurvey::base_frame() const {
  if (!config_.base_frame.empty()) return config_.base_frame;
  const Seen& legs = seen(Role::kLegs);
  if (!legs.child_frame.empty()) return legs.child_frame;
  const bool twist = !legs.frame.empty() && legs.type != "nav_msgs/Odometry";
  if (twist && !is_world_frame(legs.frame)) return legs.frame;
  const std::string& joints = seen(Role::kJoints).frame;
  if (!joints.empty() && frames_.contains(joints)) return joints;
  for (const char* name : {"base", "base_link", "trunk", "body"}) {
    if (frames_.contains(name)) return name;
  }
  return {};
}

void RecordingSurvey::decide_frames(RecordingPlan& plan) const {
  RecordingSetup& setup = plan.setup;
  const std::string lidar =
      config_.lidar_frame.empty() ? seen(Role::kLidar).frame : config_.lidar_frame;
  if (!topics_.lidar.empty()) {
    setup.rig.T_body_lidar =
        frames_.extrinsic(config_.T_imu_lidar, imu_frame(), lidar, "T_imu_lidar", setup.notes);
  }
  if (setup.has_legs) {
    setup.rig.T_body_base =
        frames_.extrinsic(config_.T_imu_base, imu_frame(), base_frame(), "T_imu_base", setup.notes);
  }
  plan.legs.T_body_base = setup.rig.T_body_base;
}

/// The frame of the truth, and the body pose in it.
void RecordingSurvey::decide_truth(RecordingPlan& plan) const {
  plan.setup.has_truth = !topics_.truth.empty();
  const std::string& child = seen(Role::kTruth).child_frame;
  if (!plan.setup.has_truth || child == imu_frame()) return;
  const auto pose = frames_.find(child, imu_frame(), plan.setup.notes);
  if (!pose) {
    plan.setup.notes.push_back(
        fmt::format("the truth's frame '{}' is not connected to the IMU's '{}': "
                    "assumed to be the IMU's",
                    child, imu_frame()));
    return;
  }
  plan.T_truth_body = *pose;
  plan.truth_is_of_body = false;
}

Result<RecordingPlan> RecordingSurvey::decide(const std::filesystem::path& bag,
                                              std::vector<std::string> notes) {
  RecordingPlan plan;
  plan.setup.topics = topics_;
  plan.setup.notes = std::move(notes);
  if (!topics_.lidar.empty()) {
    if (clouds_.size() == 0 && !cloud_error_.empty()) {
      return failure(fmt::format("{}: topic '{}': {}", bag.string(), topics_.lidar, cloud_error_));
    }
    plan.cloud = clouds_.decide(config_, plan.setup.notes);
    plan.setup.has_point_times = plan.cloud.clock != PointClock::kNone;
    plan.setup.rings = plan.cloud.rings;
  }
  decide_stamps(plan);
  decide_imu(plan);
  if (auto legs = decide_legs(plan); !legs) {
    return failure(fmt::format("{}: {}", bag.string(), legs.error().message));
  }
  decide_frames(plan);
  decide_truth(plan);
  for (const auto& [what, times] : frames_.counts()) {
    plan.setup.notes.push_back(fmt::format("{} {} times: ignored", what, times));
  }
  return plan;
}

}  // namespace aims
