// SPDX-License-Identifier: BSD-3-Clause
#include "live/live_estimate.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "live/live_source.hpp"
#include "live/program.hpp"
#include "recordings/source/decided_start.hpp"

namespace aims {
namespace {

/// Record time of one batch of deliveries.
constexpr Duration kBatch = 5 * kMillisecond;
constexpr Duration kMapPeriod = 5 * kSecond;  ///< of the published map
// Of what a crash leaves behind [s].
constexpr double kSummaryPeriod = 10.0;
constexpr double kMapFilePeriod = 60.0;
constexpr double kOverload = 5.0;  ///< after the last message dropped [s]

void print_counts(const std::map<std::string, int>& counts) {
  for (const auto& [event, count] : counts) print_line(fmt::format("note: {}: {}", event, count));
}

}  // namespace

void print_missed(const MissedMessages& missed, const std::string& of) {
  const auto print = [&of](std::size_t count, const char* what) {
    if (count > 0) print_line(fmt::format("note: {} messages {}{}", count, what, of));
  };
  print(missed.dropped, "dropped, since the node was too slow");
  print(missed.lost, "lost by the network");
}

LiveEstimate::LiveEstimate(Transport& transport, Publications& publications,
                           RecordingReader& reader, Estimator& estimator, LiveLog log,
                           LiveStart start)
    : transport_(transport),
      publications_(publications),
      reader_(reader),
      estimator_(estimator),
      source_(dynamic_cast<const MotionSource*>(&estimator)),
      log_(std::move(log)),
      start_(std::move(start)),
      dropped_(missed().dropped),
      read_warnings_(reader.setup().warnings.size()) {}

Result<void> LiveEstimate::run() {
  if (auto ok = log_.save_summary(reader_, estimator_.result(), false); !ok) return ok;
  std::vector<Delivery> deliveries;
  bool more = true;
  while (more && !estimator_.result().failure) {
    const auto advanced = reader_.advance(kBatch, deliveries);
    if (!advanced) return tl::unexpected(advanced.error());
    more = *advanced;
    warn_of_changes();
    for (const Delivery& delivery : deliveries) take(delivery);
    deliveries.clear();
    for (const std::string& problem : transport_.take_problems()) {
      print_line("warning: " + problem);
      warning_ = problem;
    }
    save_now_and_then();
  }
  if (estimator_.result().failure) tell_invalid("the estimator has failed", 0.0);
  ended_ = true;
  estimator_.finish();
  take_rows();
  std::vector<HealthRow> rest;
  add_silence(rest, true);
  log_.add({}, rest);
  if (auto ok = log_.save_map(placed(estimator_.map_points())); !ok) return ok;
  if (auto ok = log_.save_summary(reader_, estimator_.result(), true); !ok) return ok;
  if (const auto& failed = estimator_.result().failure) return tl::unexpected(*failed);
  return log_.state();
}

void LiveEstimate::take(const Delivery& delivery) {
  // The deliveries of a batch arrived within 5 ms; their own arrivals are on the stamps' clock.
  timing_.arrived(delivery, reader_.summary().start + reader_.position());
  estimator_.consume(delivery);
  const bool inertial = std::holds_alternative<ImuSample>(delivery.measurement);
  if (inertial && publications_.fast_heard()) {
    const auto motion = placed_motion(std::numeric_limits<Time>::max());
    if (motion) publications_.fast(*motion);
  }
  take_rows();
}

void LiveEstimate::take_rows() {
  const EstimatorResult& result = estimator_.result();
  const auto new_poses = std::span(result.trajectory).subspan(taken_poses_);
  const auto new_health = std::span(result.health).subspan(taken_health_);
  if (new_poses.empty() && new_health.empty()) return;
  if (!new_poses.empty()) warn_of_motion();
  std::vector<StampedPose> poses(new_poses.begin(), new_poses.end());
  for (StampedPose& pose : poses) {
    if (start_.T_odom_start) pose.pose = *start_.T_odom_start * pose.pose;
    publications_.pose(pose, placed_motion(pose.stamp));
    if (!ended_) timing_.published(pose.stamp);
    last_ = pose;
  }
  if (!poses.empty()) publish_points(poses.back().stamp);
  std::vector<HealthRow> health(new_health.begin(), new_health.end());
  publish_health(health);
  add_silence(health, false);
  poses_ += poses.size();
  log_.add(poses, health);
  // All rows are taken; the estimator forgets them, so that memory does not grow.
  estimator_.forget_rows();
  taken_poses_ = result.trajectory.size();
  taken_health_ = result.health.size();
}

void LiveEstimate::warn(const ReadingWarning& warning) {
  start_.warnings.push_back(warning);
  print_line("warning: " + warning.text);
}

/// Where it starts anew and the robot does not stand.
void LiveEstimate::warn_of_motion() {
  if (!std::exchange(start_.standing, false)) return;
  if (!estimator_.result().counts.contains("initialization.moving")) return;
  warn({"started anew in motion",
        "started anew in motion: tilt and gyro bias are uncertain; let the "
        "robot stand and send calibrate"});
}

/// Of what no longer is as it was at the start.
void LiveEstimate::warn_of_changes() {
  const auto& warnings = reader_.setup().warnings;
  for (; read_warnings_ < warnings.size(); ++read_warnings_) {
    const ReadingWarning& found = warnings[read_warnings_];
    // Clouds that were dropped here are named where that happens.
    const bool named = missed().dropped > 0 && found.sensor == WarnedSensor::kLidar &&
                       found.kind == WarningKind::kMissingMessages;
    if (start_.concerns(found) && !named) warn(found);
  }
  warn_of_file(log_.state(), "the log cannot be written");
  warn_of_file(start_.recorder->state(), "the recording cannot be written");
}

/// A full disk is a warning once; the estimate goes on.
void LiveEstimate::warn_of_file(const Result<void>& state, const char* reason) {
  if (state) return;
  const auto told = std::ranges::find(start_.warnings, reason, &ReadingWarning::reason);
  if (told == start_.warnings.end()) warn({reason, state.error().message});
}

/// Messages that were dropped leave gaps, which the estimator takes for silent sensors: names the
/// cause instead.
void LiveEstimate::name_overload(HealthRow& row) {
  const std::size_t dropped = missed().dropped;
  if (std::exchange(dropped_, dropped) != dropped) since_dropped_ = Stopwatch();
  if (!since_dropped_ || since_dropped_->seconds() > kOverload) return;
  std::erase_if(row.reasons, [](const std::string& each) { return each.starts_with("no "); });
  row.reasons.insert(row.reasons.begin(),
                     fmt::format("the node is too slow: {} messages dropped", dropped));
  if (row.state == HealthState::kHealthy) row.state = HealthState::kDegraded;
}

/// What node and reading know.
std::vector<std::string> LiveEstimate::reasons_of_node() {
  std::vector<std::string> reasons = start_.clocks->differing();
  for (const ReadingWarning& each : start_.warnings) reasons.push_back(each.reason);
  const TopicsConfig& topics = reader_.setup().topics;
  const std::set used = {topics.lidar, topics.imu, topics.leg_odometry, topics.joint_states,
                         topics.contacts};
  for (const auto& [topic, count] : transport_.take_doubled()) {
    if (!used.contains(topic)) continue;
    reasons.push_back(fmt::format("{} has {} publishers", topic, count));
    record_doubled(topic, reasons.back());
  }
  return reasons;
}

/// So that a replay knows it too.
void LiveEstimate::record_doubled(const std::string& topic, const std::string& reason) {
  if (!doubled_.insert(topic).second) return;
  const auto record = [this](const BagMessage& message) { start_.recorder->add(message); };
  show_mark(record, kDoubledTopic, reader_.summary().start + reader_.position(),
            transport_.format(), reason);
}

/// Adds the reasons of the node; publishes. What was queued before a silence changes nothing of it.
void LiveEstimate::publish_health(std::vector<HealthRow>& rows) {
  for (HealthRow& row : rows) {
    name_overload(row);
    // What is found meanwhile is in the first row behind the start.
    const bool starting = row.state == HealthState::kStarting;
    const auto reasons = starting ? std::vector<std::string>() : reasons_of_node();
    if (!reasons.empty()) {
      row.state = std::max(row.state, HealthState::kDegraded);
      row.reasons.insert(row.reasons.end(), reasons.begin(), reasons.end());
    }
    const HealthRow held = hold_.held(row);
    if (row.stamp >= silent_at_) publish(held);
  }
}

/// Prints too, where the state or its reasons change, not their figures alone.
void LiveEstimate::publish(const HealthRow& row) {
  const auto [scans, samples] = timing_.rates();
  std::vector<std::pair<std::string, std::string>> figures = {
      {"messages dropped", fmt::format("{}", missed().dropped)},
      {"messages lost", fmt::format("{}", missed().lost)},
      {"last warning of the network", warning_},
      {"scans per second", fmt::format("{:.1f}", scans)},
      {"IMU samples per second", fmt::format("{:.0f}", samples)},
      {"latency median [ms]", fmt::format("{}", timing_.quantile(0.5))},
      {"latency 99 % [ms]", fmt::format("{}", timing_.quantile(0.99))}};
  // What the reader left out and why: the cause of "no LiDAR scans".
  for (const auto& [what, count] : reader_.counts())
    figures.emplace_back(what, fmt::format("{}", count));
  publications_.health(row, std::move(figures));
  if (printed_ && alike(row, *printed_)) return;
  print_line(fmt::format("health at {:.1f} s: {}{}{}", to_seconds(row.stamp), name_of(row.state),
                         row.reasons.empty() ? "" : ": ", fmt::join(row.reasons, "; ")));
  printed_ = row;
}

void LiveEstimate::tell_silence(double seconds) {
  const bool published = transport_.topics().contains(reader_.setup().topics.imu);
  tell_invalid(published ? "no messages, though there are publishers" : "no messages", seconds);
}

void LiveEstimate::tell_invalid(const char* reason, double seconds) {
  HealthRow row{last_ ? last_->stamp : 0, HealthState::kInvalid, {reason}, NAN};
  row.stamp += from_seconds(seconds);
  silent_at_ = row.stamp;
  publish(row);
  if (silence_.size() > 1) silence_.pop_back();  // its begin and its end
  silence_.push_back(row);
}

/// Puts the rows of a silence among those of the estimator, which may come later: it waits for late
/// measurements. `all`: also those after the last row.
void LiveEstimate::add_silence(std::vector<HealthRow>& rows, bool all) {
  const auto end = std::ranges::find_if(silence_, [&](const HealthRow& each) {
    return !all && (rows.empty() || each.stamp > rows.back().stamp);
  });
  rows.insert(rows.end(), silence_.begin(), end);
  silence_.erase(silence_.begin(), end);
  std::ranges::stable_sort(rows, {}, &HealthRow::stamp);
}

std::vector<Eigen::Vector3f> LiveEstimate::placed(std::vector<Eigen::Vector3f> points) const {
  if (!start_.T_odom_start) return points;
  for (Eigen::Vector3f& point : points) {
    point = (*start_.T_odom_start * point.cast<double>()).cast<float>();
  }
  return points;
}

std::optional<MotionEstimate> LiveEstimate::placed_motion(Time until) const {
  auto motion = source_ != nullptr ? source_->motion(until) : std::nullopt;
  if (motion && start_.T_odom_start) motion = placed_at(*start_.T_odom_start, *motion);
  return motion;
}

void LiveEstimate::publish_points(Time stamp) {
  if (source_ != nullptr && publications_.cloud_heard()) {
    publications_.cloud(stamp, placed(source_->registered_points()));
  }
  if (stamp < next_map_ || !publications_.map_heard()) return;
  publications_.map(stamp, placed(estimator_.map_points()));
  next_map_ = stamp + kMapPeriod;
}

/// What a crash is to leave behind besides the rows.
void LiveEstimate::save_now_and_then() {
  if (log_.folder().empty() || !log_.state() || since_summary_.seconds() < kSummaryPeriod) return;
  since_summary_ = Stopwatch();
  Result<void> saved = log_.save_summary(reader_, estimator_.result(), false);
  if (saved && since_map_.seconds() > kMapFilePeriod) {
    since_map_ = Stopwatch();
    saved = log_.save_map(placed(estimator_.map_points()));
  }
  if (!saved) print_line("warning: " + saved.error().message);
}

void LiveEstimate::save_map() {
  if (log_.folder().empty()) return print_line("warning: save_map: expected --out FOLDER");
  const auto points = placed(estimator_.map_points());
  const auto saved = log_.save_map(points);
  print_line(saved ? fmt::format("map: {} points in {}", points.size(), log_.folder().string())
                   : "warning: save_map: " + saved.error().message);
}

void LiveEstimate::print_summary(bool source_time) const {
  print_counts(reader_.counts());
  print_counts(estimator_.result().counts);
  print_missed(missed(), "");
  print_line(fmt::format("{} poses", poses_));
  if (source_time || timing_.scans() == 0) return;
  print_line(fmt::format("from the arrival of a scan to its odometry: median {} ms, 99 % {} ms",
                         timing_.quantile(0.5), timing_.quantile(0.99)));
}

}  // namespace aims
