// SPDX-License-Identifier: BSD-3-Clause
#include "recordings/stream/recording_survey.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "recordings/clouds/scan_period.hpp"
#include "recordings/median.hpp"
#include "recordings/messages/message_types.hpp"
#include "recordings/stream/gravity_unit.hpp"
#include "recordings/stream/motion_window.hpp"
#include "recordings/stream/record_clock.hpp"
#include "recordings/topics/recording_topics.hpp"

namespace aims {
namespace {

constexpr std::size_t kMaxSamples = 2000;
constexpr std::size_t kMaxCloudStamps = 100;
constexpr double kMaxTurnRate = 35.0;  ///< saturation of a gyro of 2000 deg/s [rad/s]
/// Median turn rate of no walking robot [rad/s].
constexpr double kFastTurning = 4.0;
constexpr double kLeastGravity = 0.5;  ///< of the mean force, as a fraction of the median norm
/// Of a specific force in m/s^2, in the median.
constexpr double kLeastForce = 5.0, kMostForce = 15.0;
constexpr double kStrangeImu = 5.0;    ///< of stamps in another unit [Hz]
constexpr double kSlowImu = 40.0;      ///< too slow for a walk [Hz]
constexpr double kSlowLegs = 20.0;     ///< a stance of a trot lasts for 0.25 s [Hz]
constexpr double kFastImu = 20'000.0;  ///< [Hz]

/// Replaces the nominal rate of a sensor by the measured one where they differ by more than 10 %.
void adopt_rate(std::optional<double> measured_hz, const char* sensor, double& nominal_hz,
                ReadingNotes& notes) {
  constexpr double kTolerance = 0.1;
  if (!measured_hz || std::abs(*measured_hz - nominal_hz) <= kTolerance * nominal_hz) return;
  nominal_hz = *measured_hz;
  notes.push_back(
      fmt::format("{}: {:.4g} Hz, the rate found in the recording", sensor, *measured_hz));
}

}  // namespace

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

double RecordingSurvey::median_norm(Eigen::Vector3d ImuSample::*part) const {
  std::vector<double> norms;
  for (const ImuSample& each : first_samples_) norms.push_back((each.*part).norm());
  return upper_median(std::move(norms)).value_or(0.0);
}

Eigen::Vector3d RecordingSurvey::force_sum() const {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (const ImuSample& each : first_samples_) sum += each.specific_force;
  return sum;
}

/// Whether any sample differs from the first one in this.
bool RecordingSurvey::changes(Eigen::Vector3d ImuSample::*part) const {
  return std::ranges::any_of(first_samples_, [&](const ImuSample& each) {
    return each.*part != first_samples_.front().*part;
  });
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

/// Warns of a specific force that is no gravity.
void RecordingSurvey::warn_of_force(double force) {
  if (force == 0.0 && largest_turn_rate_ == 0.0) {
    return notes_.warn("IMU measures nothing",
                       "gyro and accelerometer are zero in the first messages of the IMU: does it "
                       "give its orientation alone? Estimators need both");
  }
  const double milligravities = force / 1000.0;
  notes_.warn(
      "unit of the accelerometer unknown",
      fmt::format("specific force of {:.3g} at the start is neither gravity in m/s^2 nor in "
                  "g: {}",
                  force,
                  is_in_gravities(milligravities)
                      ? "it seems to be in mg: set recording.imu_unit=mg"
                      : "assumed to be m/s^2 (imu_unit); convert raw counts before"));
}

/// The unit of the accelerometer, which gravity gives away.
void RecordingSurvey::decide_force_unit(RecordingPlan& plan) {
  ReadingNotes& notes = notes_;
  const double force = median_norm(&ImuSample::specific_force);
  const bool milli = config_.imu_unit == ImuUnit::kMilligravities;
  bool gravities = milli || config_.imu_unit == ImuUnit::kGravities;
  // Gravity adds up over the samples; accelerations of a walk without it do not.
  const bool any = !first_samples_.empty();
  const double mean = any ? force_sum().norm() / static_cast<double>(first_samples_.size()) : 0.0;
  const bool gravity_free = any && mean < kLeastGravity * force;
  if (gravity_free) {
    notes.warn("accelerometer without gravity",
               fmt::format("specific force of {:.3g} in the median but {:.3g} in the mean: gravity "
                           "is taken out, or the axes change; estimators need it as measured",
                           force, mean));
  } else if (config_.imu_unit == ImuUnit::kAuto && any) {
    gravities = is_in_gravities(force);
    if (!gravities && (force < kLeastForce || force > kMostForce)) warn_of_force(force);
  }
  if (gravities) {
    plan.force_scale = milli ? kStandardGravity / 1000.0 : kStandardGravity;
    notes.push_back(fmt::format("IMU in {} ({:.4g} at the start): multiplied by {}",
                                milli ? "mg" : "g", force, plan.force_scale));
  }
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

void RecordingSurvey::warn_of_rate(double rate) {
  if (rate < kStrangeImu || rate > kFastImu) {
    notes_.warn("rate of the IMU",
                fmt::format("IMU of {:.3g} Hz by its stamps: are they in another unit than seconds "
                            "(of a table: time_unit of its mapping), or are most of them lost?",
                            rate));
  } else if (rate < kSlowImu) {
    notes_.warn("IMU is slow",
                fmt::format("IMU of {:.3g} Hz: a walk shakes faster than it samples, estimates "
                            "that rely on it drift; 50 Hz at least are expected, 100 Hz or more "
                            "recommended: is it sent at a reduced rate?",
                            rate));
  }
}

void RecordingSurvey::decide_imu(RecordingPlan& plan) {
  ReadingNotes& notes = notes_;
  plan.setup.imu_rate_hz = rate_of(Role::kImu, plan);
  plan.setup.has_orientation = oriented_;
  adopt_rate(plan.setup.imu_rate_hz, "IMU", plan.setup.rig.imu_rate_hz, notes);
  if (const auto rate = plan.setup.imu_rate_hz) warn_of_rate(*rate);
  decide_force_unit(plan);
  for (const std::string& type : unstamped_states()) {
    notes.push_back(fmt::format("{} has no stamp: record times are used", type));
  }
  if (config_.gyro_unit == GyroUnit::kDegrees) {
    plan.turn_scale = std::numbers::pi / 180.0;
    notes.push_back("angular velocity in deg/s (recording.gyro_unit): converted to rad/s");
  }
  warn_of_gyro(plan);
  warn_of_gravity(plan);
}

/// Warns of a gyro whose numbers no robot turns by.
void RecordingSurvey::warn_of_gyro(const RecordingPlan& plan) {
  const double turning = plan.turn_scale * median_norm(&ImuSample::angular_velocity);
  const double fastest = plan.turn_scale * largest_turn_rate_;
  constexpr std::size_t kLeast = 100;  // samples
  constexpr double kFewBeyond = 0.01;  // of them
  if (first_samples_.size() >= kLeast && !changes(&ImuSample::angular_velocity) &&
      changes(&ImuSample::specific_force)) {
    const Eigen::Vector3d rate = first_samples_.front().angular_velocity.array() + 0.0;  // no -0
    notes_.warn("gyroscope does not measure",
                fmt::format("angular velocity is ({:.3g}, {:.3g}, {:.3g}) in all {} samples while "
                            "the specific force changes: the gyro is off or not filled in",
                            rate.x(), rate.y(), rate.z(), first_samples_.size()));
  }
  const auto beyond = std::ranges::count_if(first_samples_, [&](const ImuSample& each) {
    return plan.turn_scale * each.angular_velocity.norm() > kMaxTurnRate;
  });
  const bool spikes = static_cast<double>(beyond) < kFewBeyond * std::ssize(first_samples_);
  if (fastest > kMaxTurnRate && turning < kFastTurning && spikes) {
    notes_.warn("gyroscope has spikes",
                fmt::format("{} of the first {} samples of the gyro are beyond {:.0f} rad/s, up to "
                            "{:.3g}, {:.3g} in the median: single samples are corrupt",
                            beyond, first_samples_.size(), kMaxTurnRate, fastest, turning));
  } else if (fastest > kMaxTurnRate || turning > kFastTurning) {
    notes_.warn("gyroscope perhaps in deg/s",
                fmt::format("angular velocity up to {:.3g}, {:.3g} in the median: rad/s are "
                            "expected, are these deg/s? Then set recording.gyro_unit=deg/s (of a "
                            "table: gyro_unit of its mapping)",
                            fastest, turning));
  }
}

/// The mean specific force of the second without motion in which it is nearest to gravity.
std::optional<double> RecordingSurvey::force_at_rest(const RecordingPlan& plan) const {
  std::optional<double> nearest;
  MotionWindow window;
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  int count = 0;
  for (const ImuSample& each : first_samples_) {
    if (window.length_to(each.stamp) >= kSecond) {
      const double force = sum.norm() / count;
      const bool nearer =
          !nearest || std::abs(force - kStandardGravity) < std::abs(*nearest - kStandardGravity);
      if (!window.moves() && nearer) nearest = force;
      window = {};
      sum.setZero();
      count = 0;
    }
    const Eigen::Vector3d force = plan.force_scale * each.specific_force;
    window.add(each.stamp, plan.turn_scale * each.angular_velocity, force);
    sum += force;
    ++count;
  }
  return nearest;
}

/// Warns of a robot at rest whose specific force is not gravity.
void RecordingSurvey::warn_of_gravity(const RecordingPlan& plan) {
  constexpr double kTolerance = 0.05;  // biases are below 0.02
  const double force = force_at_rest(plan).value_or(kStandardGravity);
  const double off = std::abs(force / kStandardGravity - 1.0);
  // Beyond, the unit is warned of.
  if (off < kTolerance || force < kLeastForce || force > kMostForce) return;
  notes_.warn("accelerometer does not measure gravity",
              fmt::format("specific force of {:.2f} m/s^2 at rest is {:.0f} % off gravity: the "
                          "scale of the accelerometer or of one of its axes is wrong",
                          force, 1e2 * off));
}

/// Warns of a robot that stands for no second of the first two: the estimate begins with the
/// longest part of them that is undisturbed.
void RecordingSurvey::warn_of_motion(const RecordingPlan& plan) {
  if (first_samples_.empty()) return;
  MotionWindow window;
  int windows = 0;
  int moving = 0;
  Time last = first_samples_.front().stamp;
  const auto judge = [&] {
    if (window.length_to(last) < kSecond * 9 / 10) return;
    ++windows;
    if (window.moves()) ++moving;
  };
  for (const ImuSample& each : first_samples_) {
    const Duration since = each.stamp - first_samples_.front().stamp;
    if (since < 0 || since >= 2 * kSecond) break;
    if (window.length_to(each.stamp) >= kSecond) {
      judge();
      window = {};
    }
    window.add(each.stamp, plan.turn_scale * each.angular_velocity,
               plan.force_scale * each.specific_force);
    last = each.stamp;
  }
  judge();
  if (windows == 0 || moving < windows) return;
  notes_.warn("robot moves at the start",
              "the robot moves in the first two seconds, in which it is taken to stand: tilt, "
              "velocity and gyro bias are then wrong; begin the recording before it walks");
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
  stream.geometry = config_.leg_geometry;
  stream.foot_model = config_.foot_model;
  stream.source = legs_.decide_source(legs.type, legs.frame, notes_);
  stream.contacts_on_change = legs_.contacts_hold(notes_);
  const bool kinematic = stream.source == LegSource::kKinematics;
  plan.setup.leg_rate_hz = rate_of(kinematic ? Role::kJoints : Role::kLegs, plan);
  plan.joints = legs_.joint_rule();
  plan.setup.leg_lack = legs_.lack();
  plan.setup.has_legs = stream.source != LegSource::kNone;
  // Samples of feet have no angles.
  plan.setup.has_joints = stream.source != LegSource::kFeet && legs_.has_joints_and_contacts();
  plan.setup.rig.leg_geometry = config_.leg_geometry;
  adopt_rate(plan.setup.leg_rate_hz, "leg odometry", plan.setup.rig.leg_rate_hz, notes_);
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
  return plan;
}

}  // namespace aims
