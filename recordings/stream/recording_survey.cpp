// SPDX-License-Identifier: BSD-3-Clause
#include "recordings/stream/recording_survey.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "recordings/clouds/scan_period.hpp"
#include "recordings/messages/message_types.hpp"
#include "recordings/stream/record_clock.hpp"
#include "recordings/topics/recording_topics.hpp"

namespace aims {
namespace {

constexpr std::size_t kMaxSamples = 2000;
constexpr std::size_t kMaxCloudStamps = 100;
constexpr double kSlowLegs = 20.0;  ///< a stance of a trot lasts for 0.25 s [Hz]

}  // namespace

void RecordingSurvey::adopt_rate(std::optional<double> measured_hz, const char* sensor,
                                 double& nominal_hz) {
  constexpr double kTolerance = 0.1;
  if (!measured_hz || std::abs(*measured_hz - nominal_hz) <= kTolerance * nominal_hz) return;
  nominal_hz = *measured_hz;
  notes_.push_back(
      fmt::format("{}: {:.4g} Hz, the rate found in the recording", sensor, *measured_hz));
}

void RecordingSurvey::note_times(Role role, const MessageView& view, const BagMessage& message,
                                 bool is_new) {
  Seen& each = seen(role);
  const Time record_time = message.taken();
  if (record_time > kSetRecordTime) {
    first_set_ = std::min(first_set_.value_or(record_time), record_time);
  }
  if (each.stamps.size() >= kMaxSamples) return;
  const Time stamp = header_stamp(view, record_time);
  each.unstamped = each.unstamped || !recorded_stamp(view);
  each.stamps.push_back(stamp);
  each.latencies.push_back(record_time - stamp);
  each.is_new.push_back(is_new);
  each.delays.push_back(message.record_time - message.sampled.value_or(stamp));
  if (each.frame.empty()) each.frame = view.text("header.frame_id").value_or("");
  if (each.child_frame.empty()) each.child_frame = view.text("child_frame_id").value_or("");
}

void RecordingSurvey::add(const BagMessage& message, const Channel& channel) {
  const auto view = channel.decoder.decode(message.data);
  if (!view) {
    if (channel.is(Role::kLidar) && cloud_error_.empty()) cloud_error_ = view.error().message;
    return;
  }
  const bool is_new = repeats_[channel.connection->topic].add(header_stamp(*view, message.taken()),
                                                              sample_numbers(*view, channel));
  for (std::size_t i = 0; i < kRoleCount; ++i) {
    if (!channel.serves[i]) continue;
    note_times(static_cast<Role>(i), *view, message, is_new);
    seen_[i].type = channel.connection->type;
    seen_[i].state = channel.state;
  }
  if (channel.is(Role::kLidar) && !clouds_.enough()) add_cloud(*view, message.record_time);
  if (channel.is(Role::kImu)) add_imu(*view);
  const StateLayout* state = channel.state;
  if (channel.is(Role::kLegs) && state != nullptr) legs_.add_feet(*view, *state);
  if (channel.is(Role::kJoints)) legs_.add_joints(*view, message.taken(), state);
  if (channel.is(Role::kContacts)) {
    legs_.add_contacts(*view, channel.connection->type, channel.decoder, state);
  }
}

void RecordingSurvey::add_motion(const BagMessage& message, const Channel& channel) {
  const auto view = channel.decoder.decode(message.data);
  if (!view) return;
  if (channel.is(Role::kImu)) {
    EventCounts ignored;
    const auto sample = imu_at(*view, 0, ignored);
    if (sample && sample->angular_velocity.allFinite()) {
      legs_.add_imu_motion(sample->angular_velocity);
    }
  }
  if (channel.is(Role::kContacts)) legs_.add_load_motion(*view);
  if (channel.is(Role::kJoints)) legs_.add_joint_motion(*view, message.taken());
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
  if (first_samples_.size() < kMaxSamples) first_samples_.push_back(*sample);
  largest_turn_rate_ = std::max(largest_turn_rate_, sample->angular_velocity.norm());
  oriented_ = oriented_ || sample->orientation.has_value();
}

bool RecordingSurvey::enough(const std::string& topic) const {
  if (topic == topics_.lidar) {
    return clouds_.enough() && seen(Role::kLidar).stamps.size() >= kMaxCloudStamps;
  }
  for (std::size_t i = 0; i < kRoleCount; ++i) {
    if (topic_of(topics_, static_cast<Role>(i)) != topic) continue;
    if (seen_[i].stamps.size() < kMaxSamples) return false;
  }
  return true;
}

/// The types of robots' states that are read and have no stamp.
std::set<std::string> RecordingSurvey::unstamped_states() const {
  std::set<std::string> types;
  for (const Seen& each : seen_) {
    if (each.unstamped && each.state != nullptr) types.insert(each.type);
  }
  return types;
}

/// By the times that serve as stamps.
std::optional<double> RecordingSurvey::rate_of(Role role, const RecordingPlan& plan) const {
  const Seen& each = seen(role);
  std::vector<Time> times = each.stamps;
  if (!plan.stamped_by_record[static_cast<std::size_t>(role)]) {
    return sample_rate(std::move(times));
  }
  for (std::size_t i = 0; i < times.size(); ++i) times[i] += each.latencies[i];
  const auto in_batches = batched_rate(times);
  return in_batches ? in_batches : sample_rate(std::move(times));
}

/// Warns of an odometry whose name does not say that it is of legs or of the robot alone.
void RecordingSurvey::warn_of_odometry(const std::string& type) {
  constexpr auto kEstimators = std::to_array<std::string_view>(
      {"lio", "loam", "slam", "icp", "vio", "vins", "lidar", "visual", "camera", "zed", "fused",
       "filtered", "ekf", "amcl", "gps", "gnss", "map", "estimat"});
  const std::string& topic = topics_.leg_odometry;
  if (!config_.topics.leg_odometry.empty() || type != "nav_msgs/Odometry") return;
  if (topic == kLegOdometryTopic) return;
  notes_.push_back(
      fmt::format("leg odometry: {}, the only nav_msgs/Odometry not named as a truth", topic));
  const auto named = [&](std::string_view part) { return topic.find(part) != std::string::npos; };
  if (named("leg") || std::ranges::none_of(kEstimators, named)) return;
  notes_.warn("leg odometry is perhaps of another estimator",
              fmt::format("{} is taken as leg odometry, though by its name it is the estimate of "
                          "another system: if it is, set recording.topics.leg_odometry=none",
                          topic));
}

void RecordingSurvey::warn_of_slow_legs(const std::optional<double>& rate) {
  if (!rate || *rate >= kSlowLegs) return;
  notes_.warn("legs are slow",
              fmt::format("legs of {:.3g} Hz: a foot stands for few samples, and where speeds are "
                          "differences they are too low; 50 Hz or more are recommended: are they "
                          "sent at a reduced rate?",
                          *rate));
}

/// Joints and contacts that are used beside other legs, in messages of their own: they can pause
/// alone.
void RecordingSurvey::watch_joints_and_contacts(RecordingPlan& plan) const {
  const LegSource source = plan.legs.source;
  const auto period = [&](Role role) -> Duration {
    const auto rate = rate_of(role, plan);
    return rate && *rate > 0.0 ? from_seconds(1.0 / *rate) : 0;
  };
  const std::string& joints = topics_.joint_states;
  const bool own_joints = joints != topics_.imu && joints != topics_.leg_odometry;
  const bool beside = source == LegSource::kOdometry || source == LegSource::kTwist;
  if (beside && own_joints && plan.setup.has_joints) plan.joint_period = period(Role::kJoints);
  const std::string& contacts = topics_.contacts;
  const bool own_contacts =
      contacts != topics_.imu && contacts != topics_.leg_odometry && contacts != joints;
  const bool used = plan.setup.has_joints || source == LegSource::kFeet;
  if (used && source != LegSource::kNone && own_contacts && !plan.legs.contacts_on_change) {
    plan.contact_period = period(Role::kContacts);
  }
}

void RecordingSurvey::decide_legs(RecordingPlan& plan) {
  const Seen& legs = seen(Role::kLegs);
  warn_of_odometry(legs.type);
  ReadingNotes ignored;  // the frames are decided, and noted, later
  legs_.decide_order(
      frames_.extrinsic(config_.T_imu_base, imu_frame(), base_frame(), "T_imu_base", ignored)
          .rotation,
      notes_);
  auto contacts = legs_.decide_contacts(notes_);
  plan.contacts =
      contacts ? std::move(*contacts) : legs_.without_contacts(contacts.error().message, notes_);
  LegStreamConfig& stream = plan.legs;
  for (std::size_t leg = 0; leg < stream.without_contacts.size(); ++leg) {
    stream.without_contacts[leg] = std::isinf(plan.contacts.thresholds[leg].begin);
  }
  stream.geometry = config_.leg_geometry;
  stream.foot_model = config_.foot_model;
  stream.source = legs_.decide_source(legs.type, legs.frame, notes_);
  stream.contacts_on_change = legs_.contacts_hold(notes_);
  const bool kinematic = stream.source == LegSource::kKinematics;
  plan.setup.leg_rate_hz = rate_of(kinematic ? Role::kJoints : Role::kLegs, plan);
  plan.joints = legs_.joint_rule();
  plan.setup.leg_lack = legs_.lack();
  plan.setup.contacts_unknown = legs_.contacts_unknown();
  plan.setup.has_legs = stream.source != LegSource::kNone;
  // Samples of feet have no angles.
  plan.setup.has_joints = stream.source != LegSource::kFeet && legs_.has_joints_and_contacts();
  plan.setup.rig.leg_geometry = config_.leg_geometry;
  watch_joints_and_contacts(plan);
  adopt_rate(plan.setup.leg_rate_hz, "leg odometry", plan.setup.rig.leg_rate_hz);
  if (kinematic || stream.source == LegSource::kFeet) warn_of_slow_legs(plan.setup.leg_rate_hz);
  const double rate = plan.setup.leg_rate_hz.value_or(100.0);
  stream.half_period = from_seconds(std::clamp(0.5 / rate, 1e-9, 0.5));
  const Duration late = contact_lateness(plan);
  const Duration burst = std::max(burst_of(Role::kJoints), burst_of(Role::kContacts));
  for (const Duration each : {late, burst}) {
    if (each > stream.half_period) stream.contact_wait = std::max(stream.contact_wait, 2 * each);
  }
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

/// Whether legs and IMU are of one message or table of the robot, in the axes of its body.
bool RecordingSurvey::is_imu_of_base() const {
  if (seen(Role::kContacts).type == kFootForces) return true;
  const bool of_state = seen(Role::kImu).state != nullptr;
  return of_state && (topics_.joint_states == topics_.imu || topics_.leg_odometry == topics_.imu);
}

void RecordingSurvey::decide_frames(RecordingPlan& plan) {
  RecordingSetup& setup = plan.setup;
  const std::string lidar =
      config_.lidar_frame.empty() ? seen(Role::kLidar).frame : config_.lidar_frame;
  const bool silent =
      !topics_.imu.empty() && topics_.imu != "none" && seen(Role::kImu).stamps.empty();
  if (!topics_.lidar.empty() && is_world_frame(lidar)) {
    notes_.warn("clouds are perhaps registered",
                fmt::format("{}: its frame '{}' is by its name one of the world: clouds that "
                            "another system has moved there are no scans; choose the LiDAR's own "
                            "(topics.lidar), or name its frame (lidar_frame)",
                            topics_.lidar, lidar),
                WarnedSensor::kLidar);
  }
  if (!topics_.lidar.empty() && !silent) {
    setup.rig.T_body_lidar =
        frames_.extrinsic(config_.T_imu_lidar, imu_frame(), lidar, "T_imu_lidar", notes_);
  }
  if (setup.has_legs && is_imu_of_base() && !config_.T_imu_base.is_given() &&
      !frames_.find(imu_frame(), base_frame(), notes_)) {
    notes_.push_back("the IMU of the robot's state is taken to be at its base (T_imu_base)");
  } else if (setup.has_legs) {
    setup.rig.T_body_base =
        frames_.extrinsic(config_.T_imu_base, imu_frame(), base_frame(), "T_imu_base", notes_);
  }
  plan.legs.T_body_base = setup.rig.T_body_base;
  warn_of_up(setup);
}

/// A robot starts upright: its IMU measures an upward force in the axes of the LiDAR and the base.
void RecordingSurvey::warn_of_up(const RecordingSetup& setup) {
  const Eigen::Vector3d force = force_sum();
  const double norm = force.norm();
  if (!(norm > 0.0)) return;
  const auto warn = [&](bool used, const Pose& T_body_sensor, std::string_view sensor,
                        std::string_view key) {
    const Eigen::Vector3d up = T_body_sensor.rotation.conjugate() * force / norm;
    if (!used || up.z() > -0.5) return;
    notes_.warn(
        "IMU upside down, or a sign of the accelerometer wrong",
        fmt::format("the specific force points down in the axes of the {} at the start: the "
                    "IMU is upside down (set recording.{}), or its z has the wrong sign",
                    sensor, key));
  };
  warn(!topics_.lidar.empty(), setup.rig.T_body_lidar, "LiDAR", "T_imu_lidar");
  warn(setup.has_legs, setup.rig.T_body_base, "base", "T_imu_base");
}

/// The frame of the truth, and the body pose in it.
void RecordingSurvey::decide_truth(RecordingPlan& plan) {
  plan.setup.has_truth = !topics_.truth.empty();
  const std::string& child = seen(Role::kTruth).child_frame;
  if (!plan.setup.has_truth || child == imu_frame()) return;
  const auto pose = frames_.find(child, imu_frame(), notes_);
  if (!pose) {
    notes_.push_back(
        fmt::format("the truth's frame '{}' is not connected to the IMU's '{}': "
                    "assumed to be the IMU's",
                    child, imu_frame()));
    return;
  }
  plan.T_truth_body = *pose;
  plan.truth_is_of_body = false;
}

Time RecordingSurvey::start(const BagSummary& summary) const {
  constexpr Duration kMostBefore = 60 * kSecond;  // of fixed transforms in a file of their own
  if (!first_set_) return summary.start;
  const bool unset = summary.start < kSetRecordTime;
  return unset || *first_set_ - summary.start > kMostBefore ? *first_set_ : summary.start;
}

/// Marks the warnings from `first` on as those of a sensor.
void RecordingSurvey::warn_of(WarnedSensor sensor, std::size_t first) {
  for (std::size_t i = first; i < notes_.warnings.size(); ++i) notes_.warnings[i].sensor = sensor;
}

Result<RecordingPlan> RecordingSurvey::decide(const std::filesystem::path& bag,
                                              std::vector<std::string> notes) {
  RecordingPlan plan;
  plan.setup.topics = topics_;
  notes_.notes = std::move(notes);
  if (!topics_.lidar.empty()) {
    if (clouds_.size() == 0 && !cloud_error_.empty()) {
      return failure(fmt::format("{}: topic '{}': {}", bag.string(), topics_.lidar, cloud_error_));
    }
    plan.cloud = clouds_.decide(config_, notes_);
    warn_of(WarnedSensor::kLidar, 0);
    plan.setup.has_point_times = plan.cloud.clock != PointClock::kNone;
    plan.setup.rings = plan.cloud.rings;
  }
  decide_repeats(plan);
  decide_stamps(plan);
  decide_waits(plan);
  decide_imu(plan);
  const std::size_t before_legs = notes_.warnings.size();
  decide_legs(plan);
  warn_of(WarnedSensor::kLegs, before_legs);
  decide_begin(plan);
  if (!plan.begin) warn_of_motion(plan);
  decide_frames(plan);
  decide_truth(plan);
  plan.lidar_frame = seen(Role::kLidar).frame;
  plan.frames = frames_;
  for (const auto& [what, times] : frames_.counts()) {
    notes_.push_back(fmt::format("{} {} times: ignored", what, times));
  }
  plan.setup.notes = std::move(notes_.notes);
  plan.setup.warnings = std::move(notes_.warnings);
  plan.setup.stamp_faults = std::move(notes_.stamp_faults);
  return plan;
}

}  // namespace aims
